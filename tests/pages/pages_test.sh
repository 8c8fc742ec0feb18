#!/usr/bin/env bash
# pages_test.sh PROGRAM THESIS_SUITE SCENARIOS: looks at the pages of a run, a sweep and a regression, which one small
# regression makes all of, and at that of the thesis's claims.
set -eu

here="$(cd "$(dirname "$0")" && pwd)"
program="$1"
thesis_suite="$2"
thesis="$3/thesis"
scratch="$(mktemp -d)"
trap 'rm -rf "$scratch"' EXIT
cd "$scratch"

cat >base.yaml <<'YAML'
world: {scene: conference_room}
rig: {camera: {rate_hz: 10}}
motion: {rest_s: 0.5, smoothing_s: 0.5, waypoints: [[0, 0, 1.5], [1, 0, 1.5]]}
YAML
cat >suite.yaml <<'YAML'
scenarios: {bright: base.yaml, dark: {scenario: base.yaml, set: {world.light.lux: 0.01}}}
seeds: 3
YAML
for more in --update ""; do
  "$program" regress suite.yaml --baseline baseline.json --out out $more >/dev/null
done
# One claim stands for all: to plan their runs takes half a minute.
{ echo experiments: && sed -n '/id: ch4_hand_lobby/,/^$/p' "$thesis/experiments.yaml"; } |
  sed "s#scenario: #scenario: $thesis/#" >claims.yaml
cp "$thesis/results.json" .
"$thesis_suite" --list --table claims.yaml --results results.json --out claims >/dev/null
"$here/check_page.sh" out/regress.html out/report.html out/runs/0000/report.html claims/thesis.html
