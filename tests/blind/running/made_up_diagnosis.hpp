/// A diagnosis as `recald diagnose` writes it, small enough to translate by hand.
#pragma once

#include "tests/blind/running/diagnosis_line.hpp"

namespace recald::blind::made_up {

inline Json fit(double log_score, double cvrmse) {
  return {{"nmbe_sim_minus_meas", 0.0},
          {"cvrmse", cvrmse},
          {"cvrmse_daily", 0.3},
          {"discrepancy_share", 0.9},
          {"log_score", log_score}};
}

inline Json parameter(const char* name, const char* unit, double q05, double q95) {
  const double mode = 0.5 * (q05 + q95);
  return {{"name", name}, {"unit", unit}, {"mode", mode}, {"sd", 0.1},
          {"q05", q05},   {"q50", mode},  {"q95", q95}};
}

inline Json candidate(const char* effect, double probability) {
  return {{"effect", effect},
          {"probability", probability},
          {"parameters", Json::array({parameter("amount", "kW", 1.0, 2.0)})},
          {"evidence_gain", 40.0}};
}

inline Json addition(const char* effect, Json posterior) {
  return {{"effect", effect}, {"parameters", Json::array({std::move(posterior)})}};
}

/// A wrong scale, named at one of two meters, and from the second pass a clock.
inline Json diagnosis() {
  Json electricity = candidate("scale_fault", 0.5);
  electricity["meter"] = "electricity";
  Json heating = candidate("scale_fault", 0.3);
  heating["meter"] = "heating";
  return {
      {"outcome", "named"},
      {"why", "one effect explains the gap better than all others together"},
      {"not_confirmed", false},
      {"located", Json::array({{{"meter", "heating"}, {"t", 9.0}},
                               {{"meter", "electricity"}, {"t", -8.0}},
                               {{"meter", "heating"}, {"t", 7.0}}})},
      {"candidates", Json::array({electricity,
                                  heating,
                                  {{"effect", "none"}, {"probability", 0.15}},
                                  {{"effect", "unknown"}, {"probability", 0.05}}})},
      {"confusable", Json::array()},
      {"added", {"scale_fault", "clock_offset"}},
      {"additions", Json::array({addition("scale_fault", parameter("scale", "-", 0.9, 0.94)),
                                 addition("clock_offset", parameter("offset", "h", -1.0, 0.5))})},
      {"gap",
       {{"hourly",
         {{"before", {{"electricity", fit(-60.0, 0.2)}, {"heating", fit(-50.0, 0.1)}}},
          {"after", {{"electricity", fit(-55.0, 0.05)}, {"heating", fit(-51.0, 0.12)}}},
          {"log_score_change",
           {{"electricity", {{"sum", 35.0}, {"se", 4.0}}},
            {"heating", {{"sum", -7.0}, {"se", 2.0}}}}},
          {"confirmed", true}}},
        {"epc", {{"before", Json::object()}, {"after", Json::object()}}}}},
      {"seed", 1}};
}

/// Nothing was found.
inline Json empty_diagnosis() {
  Json nothing = diagnosis();
  nothing["outcome"] = "none";
  nothing["why"] = "no effect is supported strongly enough";
  nothing["added"] = Json::array();
  nothing["additions"] = Json::array();
  nothing["gap"] = nullptr;
  return nothing;
}

}  // namespace recald::blind::made_up
