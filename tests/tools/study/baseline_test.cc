#include "tools/study/baseline.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "scenarios/input_error.h"
#include "tests/scenarios/temporary_directory.h"
#include "tests/tools/study/synthetic_suite.h"

namespace plumbline {
namespace {

using ::testing::HasSubstr;

Baseline a_baseline() {
  Baseline baseline{"ci", "0123456789abcdef", "vloam", "0.1.0 (abc)", {"a processor", 2, "Debian"}, {}};
  baseline.runs = testing::synthetic_suite(3, "a");
  return baseline;
}

class BaselineTest : public ::testing::Test {
 protected:
  Baseline read(const std::string& text) const { return read_baseline(directory_.write("ci.baseline.json", text)); }
  std::string refusal(const std::string& text) const {
    try {
      read(text);
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  }
  /// What is said of an otherwise good file in which the first such part stands otherwise.
  std::string refusal_with(const std::string& part, const std::string& instead) const {
    std::string text = baseline_json(a_baseline());
    const auto at = text.find(part);
    EXPECT_NE(at, std::string::npos) << part;
    return refusal(text.replace(at, part.size(), instead));
  }

  TemporaryDirectory directory_;
};

TEST_F(BaselineTest, ComesBackAsItWasToFiveDigits) {
  Baseline before = a_baseline();
  before.runs[1].drift_percent.reset();
  before.runs[2].relative_error_by_second_m[1] = std::numeric_limits<double>::quiet_NaN();
  const std::string text = baseline_json(before);
  const Baseline after = read(text);
  EXPECT_EQ(after.suite_digest, before.suite_digest);
  EXPECT_EQ(after.machine.cpu, "a processor");
  ASSERT_EQ(after.runs.size(), before.runs.size());
  const double error_m = before.runs[0].relative_error_by_second_m[0];
  EXPECT_NEAR(after.runs[0].relative_error_by_second_m[0], error_m, 5e-5 * error_m);
  const double rotation_deg = before.runs[0].relative_rotation_by_second_deg[0];
  EXPECT_NEAR(after.runs[0].relative_rotation_by_second_deg[0], rotation_deg, 5e-5 * rotation_deg);
  EXPECT_FALSE(after.runs[1].drift_percent);
  EXPECT_TRUE(std::isnan(after.runs[2].relative_error_by_second_m[1]));
  EXPECT_EQ(baseline_json(after), text);
}

TEST_F(BaselineTest, CutShortAnywhereItIsRefused) {
  const std::string text = baseline_json(a_baseline());
  for (std::size_t size = 0; size + 3 < text.size(); size += text.size() / 25) {
    EXPECT_THAT(refusal(text.substr(0, size)), HasSubstr("cut short")) << size;
  }
}

TEST_F(BaselineTest, SaysWhatIsWrongAndWhere) {
  EXPECT_THAT(refusal_with("\"schema_version\": 2", "\"schema_version\": 7"), HasSubstr("schema version 7"));
  EXPECT_THAT(refusal_with("\"schema_version\": 2", "\"schema_version\": \"2\""), HasSubstr("schema_version"));
  EXPECT_THAT(refusal_with("\"suite_digest\"", "\"digest\""), HasSubstr("suite_digest: missing"));
  EXPECT_THAT(refusal_with("\"status\":\"ok\"", "\"status\":\"fine\""), HasSubstr("runs[0].status: found \"fine\""));
  EXPECT_THAT(refusal_with("\"seed\":1", "\"seed\":-1"), HasSubstr("runs[0].seed"));
  EXPECT_THAT(refusal_with("\"seed\":2", "\"seed\":1"), HasSubstr("stands there twice"));
  EXPECT_THAT(refusal_with("\"drift_percent\":", "\"drift_percent\":-"), HasSubstr("runs[0].drift_percent"));
  EXPECT_THAT(refusal_with("\"cpu_s\":", "\"cpu_s\":1e300,\"was\":"), HasSubstr("runs[0].cpu_s"));
  EXPECT_THAT(refusal_with("\"relative_error_by_second_mm\":[", "\"relative_error_by_second_mm\":[true,"),
              HasSubstr("expected numbers or null"));
}

TEST_F(BaselineTest, RefusesWhatIsNoBaselineAtAll) {
  for (const char* text : {"", "[]", "null", "{\"schema_version\": 1e99}", "\xff\xfe", "{\"runs\": {}}"}) {
    EXPECT_NE(refusal(text), "accepted") << text;
  }
  EXPECT_THAT(refusal(std::string(100'000, '[')), HasSubstr("no JSON"));
  EXPECT_THROW(read_baseline(directory_.path() / "missing.json"), InputError);
  EXPECT_THROW(read_baseline(directory_.path()), InputError);
}

}  // namespace
}  // namespace plumbline
