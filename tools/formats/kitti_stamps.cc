#include "tools/formats/kitti_stamps.h"

#include <chrono>

#include "sim/text_fields.h"
#include "tools/formats/text_table.h"

namespace plumbline {
namespace {

constexpr std::int64_t kSecond_ns = 1'000'000'000;

int field_of(const TextTable& table, std::string_view text, double least, double most) {
  const auto value = parse_number(text);
  if (!value || *value < least || *value > most) table.reject(quoted_field(text) + " is no part of a date and time");
  return static_cast<int>(*value);
}

std::int64_t stamp_of_date(const TextTable& table) {
  const auto date = split_fields(table.word(0), "-");
  const auto time = split_fields(table.word(1), ":");
  if (date.size() != 3 || time.size() != 3) table.reject("expected a date and time, YYYY-MM-DD hh:mm:ss.fraction");
  const std::chrono::year_month_day day{std::chrono::year(field_of(table, date[0], 1970, 2200)),
                                        std::chrono::month(static_cast<unsigned>(field_of(table, date[1], 1, 12))),
                                        std::chrono::day(static_cast<unsigned>(field_of(table, date[2], 1, 31)))};
  if (!day.ok()) table.reject("there is no such day");
  const auto seconds = parse_stamp(time[2]);
  if (!seconds || *seconds < 0 || *seconds >= 61 * kSecond_ns) table.reject("the seconds are not from 0 to 60");
  const std::int64_t days = std::chrono::sys_days(day).time_since_epoch().count();
  const std::int64_t minutes = (days * 24 + field_of(table, time[0], 0, 23)) * 60 + field_of(table, time[1], 0, 59);
  return minutes * 60 * kSecond_ns + *seconds;
}

}  // namespace

std::vector<std::int64_t> read_kitti_stamps(const std::filesystem::path& path) {
  std::vector<std::int64_t> stamps;
  TextTable table(path);
  while (table.next()) stamps.push_back(table.size() >= 2 ? stamp_of_date(table) : table.seconds_as_ns(0));
  return stamps;
}

}  // namespace plumbline
