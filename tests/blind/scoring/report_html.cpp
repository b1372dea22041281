#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "tests/blind/scoring/report.hpp"

namespace recald::blind {
namespace {

std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '&':
        out += "&amp;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

std::string_view name_of_world(std::string_view world) {
  return world == "own" ? "our own simulator" : "EnergyPlus";
}

/// A rate with its interval, and what it should reach.
struct Row {
  std::string label;
  const std::optional<Score>* score;
};

constexpr double kLeft = 330.0;
constexpr double kWidth = 420.0;
constexpr double kRow = 24.0;

double at(double share) { return kLeft + kWidth * std::clamp(share, 0.0, 1.0); }

std::string axis(double height) {
  std::string svg;
  for (int percent = 0; percent <= 100; percent += 20) {
    const double x = at(0.01 * percent);
    svg += fmt::format(
        "<line x1='{0:.1f}' x2='{0:.1f}' y1='0' y2='{1:.1f}' class='grid'/>"
        "<text x='{0:.1f}' y='{2:.1f}' class='tick'>{3} %</text>",
        x, height, height + 16.0, percent);
  }
  return svg;
}

/// Rates as dots on their 95 % intervals.
std::string rates(const std::vector<Row>& rows) {
  std::string svg;
  double y = 0.0;
  for (const Row& row : rows) {
    const std::optional<Score>& score = *row.score;
    if (!score) continue;
    const double middle = y + 0.5 * kRow;
    const std::string hits = score->hits ? fmt::format("{} of {}", *score->hits, score->cases)
                                         : fmt::format("{} cases", score->cases);
    svg += fmt::format("<text x='{:.1f}' y='{:.1f}' class='label'>{}, {}</text>", kLeft - 12.0,
                       middle + 4.0, escaped(row.label), hits);
    if (score->interval) {
      svg += fmt::format("<line x1='{:.1f}' x2='{:.1f}' y1='{:.1f}' y2='{:.1f}' class='bar'/>",
                         at(score->interval->low), at(score->interval->high), middle, middle);
    }
    svg += fmt::format("<circle cx='{:.1f}' cy='{:.1f}' r='5'/>", at(score->value), middle);
    y += kRow;
  }
  return fmt::format("<svg viewBox='0 0 {:.0f} {:.0f}' role='img'>{}{}</svg>",
                     kLeft + kWidth + 40.0, y + 24.0, axis(y), svg);
}

std::string figure_of_names(const WorldScores& world) {
  std::vector<Row> rows;
  for (const GroupScores& group : world.naming.groups) {
    rows.push_back({"right: " + group.group, &group.right});
  }
  for (const GroupScores& group : world.naming.groups) {
    if (group.group.starts_with("single, ")) rows.push_back({"first: " + group.group, &group.top1});
  }
  rows.push_back({"false name, nothing hidden", &world.naming.false_names});
  rows.push_back({"wrong name, something hidden", &world.naming.wrong_names});
  rows.push_back({"said with P of 0.8 or more: right", &world.probability.sure_names_right});
  return rates(rows);
}

/// What was said against what was true; on the line where both agree.
std::string figure_of_reliability(const ProbabilityScores& probability) {
  constexpr double kSize = 300.0;
  constexpr double kMargin = 44.0;
  const auto x = [&](double share) { return kMargin + kSize * share; };
  const auto y = [&](double share) { return kSize * (1.0 - share) + 8.0; };
  std::string svg = fmt::format(
      "<rect x='{:.0f}' y='8' width='{:.0f}' height='{:.0f}' class='frame'/>"
      "<line x1='{:.1f}' y1='{:.1f}' x2='{:.1f}' y2='{:.1f}' class='grid'/>",
      kMargin, kSize, kSize, x(0.0), y(0.0), x(1.0), y(1.0));
  for (const ReliabilityBin& bin : probability.bins) {
    if (bin.cases == 0 || !bin.right) continue;
    if (bin.right->interval) {
      svg += fmt::format("<line x1='{0:.1f}' x2='{0:.1f}' y1='{1:.1f}' y2='{2:.1f}' class='bar'/>",
                         x(bin.mean_probability), y(bin.right->interval->low),
                         y(bin.right->interval->high));
    }
    svg += fmt::format("<circle cx='{:.1f}' cy='{:.1f}' r='5'><title>{} cases</title></circle>",
                       x(bin.mean_probability), y(bin.right->value), bin.cases);
  }
  svg += fmt::format(
      "<text x='{:.0f}' y='{:.0f}' class='tick'>said</text>"
      "<text x='14' y='{:.0f}' class='tick' transform='rotate(-90 14 {:.0f})'>right</text>",
      x(0.5), kSize + 34.0, y(0.5), y(0.5));
  return fmt::format("<svg viewBox='0 0 {:.0f} {:.0f}' class='square' role='img'>{}</svg>",
                     kSize + 2.0 * kMargin, kSize + 48.0, svg);
}

std::string cell_of(const Target& target) {
  if (!target.score) return "-";
  const double scale = target.decimals ? 1.0 : 100.0;
  std::string text = fmt::format("{:.{}f}{}", scale * target.score->value,
                                 target.decimals.value_or(0), target.decimals ? "" : " %");
  if (target.score->interval) {
    text += fmt::format(" ({:.{}f} to {:.{}f})", scale * target.score->interval->low,
                        target.decimals.value_or(0), scale * target.score->interval->high,
                        target.decimals.value_or(0));
  }
  return text;
}

std::string_view class_of(Verdict verdict) {
  if (verdict == Verdict::missed) return "missed";
  return verdict == Verdict::met ? "met" : "open";
}

std::string target_table(const std::vector<Target>& targets) {
  std::string rows;
  for (const Target& target : targets) {
    rows += fmt::format(
        "<tr><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td class='{}'>{}</td></tr>\n",
        name_of_world(target.world), escaped(target.quantity), cell_of(target),
        escaped(target.minimum_text), class_of(target.minimum), verdict_name(target.minimum));
  }
  return "<table><thead><tr><th>buildings of</th><th>quantity</th><th>measured</th><th>target</th>"
         "<th></th></tr></thead><tbody>\n" +
         rows + "</tbody></table>\n";
}

std::string number_of(const std::optional<Score>& score, double scale, int decimals) {
  if (!score) return "-";
  std::string text = fmt::format("{:.{}f}", scale * score->value, decimals);
  if (score->interval) {
    text += fmt::format(" ({:.{}f} to {:.{}f})", scale * score->interval->low, decimals,
                        scale * score->interval->high, decimals);
  }
  return text + fmt::format(", n = {}", score->cases);
}

/// What was counted besides names, worlds side by side.
std::string table_of_worlds(const std::vector<WorldScores>& worlds) {
  using Cell = std::function<std::string(const WorldScores&)>;
  constexpr double kPercent = 100.0;
  const auto percent = [](const std::optional<Score>& score) {
    return number_of(score, kPercent, 1);
  };
  const auto median_of = [](const std::optional<Spread>& spread) {
    return spread ? fmt::format("{}; 95 % below {:.1f}, most {:.1f}",
                                number_of(spread->median, 1.0, 1), spread->p95, spread->max)
                  : std::string{"-"};
  };
  const std::vector<std::pair<std::string_view, Cell>> rows{
      {"gap closed on held months, share of the oracle's, large effects named",
       [](const WorldScores& world) { return number_of(world.gap.cvrmse, 1.0, 2); }},
      {"the same, all effects, named or not",
       [](const WorldScores& world) { return number_of(world.gap.cvrmse_all, 1.0, 2); }},
      {"another meter made worse, % of additions",
       [&](const WorldScores& world) { return percent(world.gap.harm); }},
      {"90 % interval of the effect holds the truth, %",
       [&](const WorldScores& world) { return percent(world.gap.effect_coverage); }},
      {"nothing hidden: CV(RMSE) over unseen months of each meter, by the drawings, %",
       [&](const WorldScores& world) { return percent(world.calibration.before); }},
      {"calibrated, the model alone, %",
       [&](const WorldScores& world) { return percent(world.calibration.after); }},
      {"calibrated, the forecast, %",
       [&](const WorldScores& world) { return percent(world.calibration.forecast); }},
      {"yardstick: the meter's regression on temperature, %",
       [&](const WorldScores& world) { return percent(world.calibration.yardstick); }},
      {"meters whose model calibrating made worse, %",
       [&](const WorldScores& world) { return percent(world.calibration.harmed); }},
      {"meters that the yardstick forecasts better, %",
       [&](const WorldScores& world) { return percent(world.calibration.beaten); }},
      {"drift: changes by date found, %",
       [&](const WorldScores& world) { return percent(world.drift.found); }},
      {"those of 3 % of a meter and more, %",
       [&](const WorldScores& world) { return percent(world.drift.found_large); }},
      {"months until the alarm",
       [](const WorldScores& world) { return number_of(world.drift.delay_months, 1.0, 1); }},
      {"alarmed before anything changed, %",
       [&](const WorldScores& world) { return percent(world.drift.early); }},
      {"likeliest cause right, %",
       [&](const WorldScores& world) { return percent(world.drift.cause_right); }},
      {"meter or building rightly blamed, %",
       [&](const WorldScores& world) { return percent(world.drift.side_right); }},
      {"causes said with P of 0.8 or more: right, %",
       [&](const WorldScores& world) { return percent(world.drift.sure_right); }},
      {"nothing hidden, yet an alarm, %",
       [&](const WorldScores& world) { return percent(world.drift.false_alarms); }},
      {"time of a diagnosis, s",
       [&](const WorldScores& world) { return median_of(world.cost.wall_s); }},
      {"memory, MB", [&](const WorldScores& world) { return median_of(world.cost.peak_rss_MB); }},
  };
  std::string html = "<table><thead><tr><th>median, or share</th>";
  for (const WorldScores& world : worlds) {
    html += fmt::format("<th>buildings of {}</th>", name_of_world(world.world));
  }
  html += "</tr></thead><tbody>\n";
  for (const auto& [what, cell] : rows) {
    html += fmt::format("<tr><td>{}</td>", what);
    for (const WorldScores& world : worlds) html += fmt::format("<td>{}</td>", cell(world));
    html += "</tr>\n";
  }
  return html + "</tbody></table>\n";
}

std::string confusion_table(const NamingScores& naming) {
  std::string rows;
  for (const auto& [truth, said] : naming.confusion) {
    std::vector<std::pair<int, std::string>> by_count;
    for (const auto& [name, count] : said) by_count.emplace_back(-count, name);
    std::ranges::sort(by_count);
    std::string list;
    for (const auto& [count, name] : by_count) {
      list += fmt::format("{}{} ({})", list.empty() ? "" : ", ", escaped(name), -count);
    }
    rows += fmt::format("<tr><td>{}</td><td>{}</td></tr>\n", escaped(truth), list);
  }
  return "<table><thead><tr><th>hidden</th><th>said</th></tr></thead><tbody>\n" + rows +
         "</tbody></table>\n";
}

constexpr std::string_view kStyle = R"(
body { font: 15px/1.5 system-ui, sans-serif; max-width: 60rem; margin: 2rem auto; padding: 0 1rem; color: #1c2733 }
table { border-collapse: collapse; margin: 1rem 0; width: 100% }
th, td { text-align: left; padding: .3rem .6rem; border-bottom: 1px solid #d6dde4; vertical-align: top }
svg { width: 100%; max-width: 52rem; height: auto; display: block; margin: 1rem 0 }
svg.square { max-width: 24rem }
.grid { stroke: #d6dde4 } .frame { fill: none; stroke: #d6dde4 } .bar { stroke: #2a6f97; stroke-width: 3 }
circle { fill: #2a6f97 } text { font-size: 13px; fill: #1c2733 } .label { text-anchor: end } .tick { text-anchor: middle; fill: #5a6875 }
.missed { color: #a4262c } .met { color: #2f6f3e } .open { color: #5a6875 }
)";

}  // namespace

std::string scores_html(const Scores& scores, const Circumstances& circumstances) {
  std::string body = fmt::format("<h1>Blind test: what {} said</h1>\n", escaped(scores.method));
  for (const std::string& warning : circumstances.warnings) {
    body += "<p><strong>" + escaped(warning) + ".</strong></p>\n";
  }
  body += fmt::format(
      "<p>{} of {} cases scored. Answers {}, results {} (SHA-256), scorer "
      "{}.</p>\n<h2>Targets</h2>\n",
      scores.cases, scores.population_cases, escaped(circumstances.whole_hash),
      escaped(circumstances.results_hash), escaped(circumstances.scorer_version));
  body += target_table(scores.targets);
  body +=
      "<p>Sizes of effects are per cent of the meter that is moved most. Lines are 95 % "
      "intervals.</p>\n";
  body += "<h2>Besides names</h2>\n" + table_of_worlds(scores.worlds);
  for (const WorldScores& world : scores.worlds) {
    body += fmt::format("<h2>Buildings of {}: {} cases</h2>\n{}", name_of_world(world.world),
                        world.cases, figure_of_names(world));
    if (world.probability.cases > 0) {
      body += "<h3>What was said, and how often it was right</h3>\n" +
              figure_of_reliability(world.probability);
    }
    body += "<h3>What was taken for what</h3>\n" + confusion_table(world.naming);
  }
  return fmt::format(
      "<!doctype html>\n<html lang='en'><head><meta charset='utf-8'>"
      "<meta name='viewport' content='width=device-width'><title>Blind test</title>"
      "<style>{}</style></head><body>\n{}</body></html>\n",
      kStyle, body);
}

}  // namespace recald::blind
