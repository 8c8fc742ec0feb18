#!/usr/bin/env bash
# check_page.sh PAGE...: opens each page in headless Chromium without a network, as wide as a desk's screen and a phone's,
# and fails if a chart is empty, a link leads nowhere, the page is wider than the screen, or the console has an error.
set -u

here="$(cd "$(dirname "$0")" && pwd)"
profile="$(mktemp -d)"
trap 'rm -rf "$profile"' EXIT
status=0

for page in "$@"; do
  for width in 1280 390; do
    shown="$(chromium --headless --no-sandbox --disable-gpu --no-first-run --disable-background-networking \
      --host-resolver-rules='MAP * ~NOTFOUND' --allow-file-access-from-files --user-data-dir="$profile" \
      --window-size="$width,2000" --enable-logging=stderr --virtual-time-budget=20000 --timeout=60000 \
      --dump-dom "file://$here/look.html?file://$(realpath "$page")&$width" 2>"$profile/said")"
    verdict="$(sed -n '/<pre id="verdict">/,/<\/pre>/p' <<<"$shown" | sed 's/<[^>]*>//g')"
    errors="$(grep 'CONSOLE' "$profile/said")"
    if [[ "$verdict" != good* ]] || [ -n "$errors" ]; then
      echo "$page at $width pixels:" "$verdict" "$errors"
      status=1
    else
      echo "$page at $width pixels: $(tail -1 <<<"$verdict")"
    fi
  done
done
exit $status
