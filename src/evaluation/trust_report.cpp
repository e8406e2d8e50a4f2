// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/trust_report.hpp"

#include <algorithm>

#include "edgevox/io/number_text.hpp"
#include "edgevox/statistics.hpp"
#include "evaluation/share.hpp"

namespace edgevox {
namespace {

/// The statuses that have a column in trust.csv; a status of ScanStatus is reported by a line here.
struct ReportedStatus {
  ScanStatus status;
  const char* column;
};
constexpr ReportedStatus kReported[] = {{ScanStatus::kFallback, "fallback"},
                                        {ScanStatus::kAmbiguous, "ambiguous"},
                                        {ScanStatus::kStale, "stale"},
                                        {ScanStatus::kTooFew, "too_few"},
                                        {ScanStatus::kTooLarge, "too_large"}};

/// Simulated recordings that differ in their seeds alone, with one stride.
struct Group {
  std::string world;
  std::string sensor;
  size_t stride = 1;
  size_t runs = 0;
  size_t wrong_runs = 0;
  std::string wrong_seeds;
  TrustCounts counts;
};

Group& groupOf(const TrustRecording& recording, size_t stride, std::vector<Group>& groups) {
  const auto found = std::find_if(groups.begin(), groups.end(), [&](const Group& group) {
    return group.world == recording.world && group.sensor == recording.sensor &&
           group.stride == stride;
  });
  if (found != groups.end()) return *found;
  Group& added = groups.emplace_back();
  added.world = recording.world;
  added.sensor = recording.sensor;
  added.stride = stride;
  return added;
}

std::vector<Group> groupsOf(const std::vector<TrustRecording>& recordings,
                            const std::vector<TrustCell>& cells) {
  std::vector<Group> groups;
  for (const TrustCell& cell : cells) {
    const TrustRecording& recording = recordings[cell.recording];
    if (recording.world.empty()) continue;
    Group& group = groupOf(recording, cell.stride, groups);
    group.counts += cell.counts;
    ++group.runs;
    if (cell.counts.wrong == 0) continue;
    ++group.wrong_runs;
    group.wrong_seeds += (group.wrong_seeds.empty() ? "" : " ") + std::to_string(recording.seed);
  }
  return groups;
}

void setErrors(const TrustCounts& counts, Table& table) {
  table.set("median_cm", 1e2 * quantile(counts.right_distances, 0.5));
  table.set("p95_cm", 1e2 * quantile(counts.right_distances, 0.95));
  if (counts.located() > 0) table.set("max_cm", 1e2 * counts.farthest);
}

void set(Table& table, const char* column, size_t count) {
  table.set(column, static_cast<double>(count));
}

const std::vector<Column> kShares = {
    {"scans", "scans", 0},           {"right", "right %", 2},
    {"lost", "lost %", 2},           {"wrong", "wrong % of located", 2},
    {"ambiguous", "ambiguous", 0},   {"fallback", "fallback", 0},
    {"median_cm", "median [cm]", 1}, {"p95_cm", "95 % [cm]", 1},
    {"max_cm", "max [cm]", 1}};

void setShares(const TrustCounts& counts, Table& table) {
  set(table, "scans", counts.scans());
  table.set("right", 1e2 * shareOf(counts.right, counts.scans()));
  table.set("lost", 1e2 * shareOf(counts.lost, counts.scans()));
  table.set("wrong", 1e2 * shareOf(counts.wrong, counts.located()));
  set(table, "ambiguous", counts.count(ScanStatus::kAmbiguous));
  set(table, "fallback", counts.count(ScanStatus::kFallback));
  setErrors(counts, table);
}

/// Columns before and after kShares.
std::vector<Column> around(std::vector<Column> before, const std::vector<Column>& after) {
  before.insert(before.end(), kShares.begin(), kShares.end());
  before.insert(before.end(), after.begin(), after.end());
  return before;
}

std::vector<std::string> namesOf(const std::vector<Column>& columns) {
  std::vector<std::string> names;
  for (const Column& column : columns) names.push_back(column.name);
  return names;
}

std::string simulatedMarkdown(const std::vector<Group>& groups) {
  const auto columns =
      around({{"world", "world"}, {"beams", "beams"}, {"stride", "every", 0}},
             {{"wrong_runs", "runs with wrong", 0}, {"runs", "of", 0}, {"seeds", "their seeds"}});
  Table table(columns);
  for (const Group& group : groups) {
    table.addRow();
    table.set("world", group.world);
    table.set("beams", group.sensor);
    set(table, "stride", group.stride);
    setShares(group.counts, table);
    set(table, "wrong_runs", group.wrong_runs);
    set(table, "runs", group.runs);
    table.set("seeds", group.wrong_seeds);
  }
  return table.markdown(namesOf(columns), 3);
}

std::string bagsMarkdown(const std::vector<TrustRecording>& recordings,
                         const std::vector<TrustCell>& cells) {
  const auto columns = around({{"bag", "bag"}, {"stride", "every", 0}}, {});
  Table table(columns);
  for (const TrustCell& cell : cells) {
    const TrustRecording& recording = recordings[cell.recording];
    if (!recording.world.empty()) continue;
    table.addRow();
    table.set("bag", recording.name);
    set(table, "stride", cell.stride);
    setShares(cell.counts, table);
  }
  return table.markdown(namesOf(columns), 2);
}

std::string totalText(const std::vector<TrustCell>& cells) {
  TrustCounts all;
  for (const TrustCell& cell : cells) all += cell.counts;
  const auto wrong_runs = std::count_if(
      cells.begin(), cells.end(), [](const TrustCell& cell) { return cell.counts.wrong > 0; });
  return std::to_string(all.scans()) + " scans in " + std::to_string(cells.size()) +
         " runs: " + std::to_string(all.right) + " right, " + std::to_string(all.lost) + " lost, " +
         std::to_string(all.wrong) + " wrong, these in " + std::to_string(wrong_runs) + " runs.\n";
}

std::string meaning() {
  return "\nEach run is every n-th scan of a recording, mapped from an empty map. A scan that is "
         "located is wrong if its pose is more than " +
         shortText(kWrongDistance) + " m or " + shortText(kWrongAngle) +
         " degrees from the true one at its stamp, after the first pose has been put to the first "
         "true one; else it is right. One that is not located is lost, whatever the reason; "
         "ambiguous: those of them that fit in more than one place. "
         "Fallback: scans aligned to all voxels. Median and 95 %: distance of the right ones from "
         "the truth; max: of all located ones. Bags: the truth is their reference, or what the "
         "default configuration finds from all scans where none is given; scans that it does not "
         "know are left out (`unknown` in trust.csv).\n";
}

}  // namespace

Table trustTable(const std::vector<TrustRecording>& recordings,
                 const std::vector<TrustCell>& cells) {
  std::vector<Column> columns = {{"recording", ""}, {"world", ""},  {"beams", ""}, {"seed", ""},
                                 {"stride", ""},    {"scans", ""},  {"right", ""}, {"wrong", ""},
                                 {"lost", ""},      {"unknown", ""}};
  for (const ReportedStatus& reported : kReported) columns.push_back({reported.column, ""});
  for (const char* name : {"median_cm", "p95_cm", "max_cm"}) columns.push_back({name, ""});
  Table table(columns);
  for (const TrustCell& cell : cells) {
    const TrustRecording& recording = recordings[cell.recording];
    table.addRow();
    table.set("recording", recording.name);
    if (!recording.world.empty()) {
      table.set("world", recording.world);
      table.set("beams", recording.sensor);
      set(table, "seed", recording.seed);
    }
    set(table, "stride", cell.stride);
    set(table, "scans", cell.counts.scans());
    set(table, "right", cell.counts.right);
    set(table, "wrong", cell.counts.wrong);
    set(table, "lost", cell.counts.lost);
    set(table, "unknown", cell.counts.unknown);
    for (const ReportedStatus& reported : kReported) {
      set(table, reported.column, cell.counts.count(reported.status));
    }
    setErrors(cell.counts, table);
  }
  return table;
}

std::string trustMarkdown(const std::vector<TrustRecording>& recordings,
                          const std::vector<TrustCell>& cells, const TrustOptions& options) {
  std::string text = "# Right, wrong and lost scans\n\nConfiguration " + options.config_name +
                     ". " + totalText(cells);
  const std::string simulated = simulatedMarkdown(groupsOf(recordings, cells));
  const std::string bags = bagsMarkdown(recordings, cells);
  if (!simulated.empty()) text += "\n" + simulated;
  if (!bags.empty()) text += "\n" + bags;
  return text + meaning();
}

}  // namespace edgevox
