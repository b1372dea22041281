// What naming learns from: for each case of a population the signatures of its meters, those of its
// fitted model, and how each parameter and each possible effect would change them.
//
//   signature_table --population DIR --out DIR [--cases 1-20]
//
// CASE.json names what CASE.f32 holds: little-endian floats, rows of all signatures.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <Eigen/Cholesky>
#include <chrono>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>

#include "core/diagnosis/candidate_shapes.hpp"
#include "core/diagnosis/joint_fit.hpp"
#include "core/diagnosis/signatures.hpp"
#include "daemon/commands/open_site.hpp"
#include "daemon/site/diagnose/site_diagnosis.hpp"
#include "daemon/site/model/modelled_site.hpp"
#include "tests/blind/scoring/case_range.hpp"
#include "tests/blind/scoring/result_log.hpp"

namespace {

using namespace recald;
using namespace recald::diagnosis;
namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

Eigen::VectorXd flat(const Eigen::MatrixXd& signatures) {
  return Eigen::Map<const Eigen::VectorXd>(signatures.data(), signatures.size());
}

/// Rough standard deviations, to find the mode; naming learns its own.
Eigen::VectorXd rough_spread() {
  const auto& names = signature_names();
  Eigen::VectorXd spread(static_cast<Eigen::Index>(names.size() * kSignatureMeters));
  for (std::size_t i = 0; i < names.size(); ++i) {
    double sd = 0.1;
    if (names[i].find("of the day, ") != std::string::npos) sd = 0.7;
    if (names[i].find("that have one") != std::string::npos) sd = 0.3;
    for (std::size_t m = 0; m < kSignatureMeters; ++m) {
      spread[static_cast<Eigen::Index>(m * names.size() + i)] = sd;
    }
  }
  return spread;
}

class Table {
 public:
  explicit Table(const SiteProblem& site) : site_(site), reader_(site), predictor_(site) {}

  void make(const fs::path& stem) {
    measured_ = flat(reader_.read(site_.measured_kW));
    fit();
    std::ofstream file(stem.string() + ".f32", std::ios::binary);
    const auto write = [&](const Eigen::VectorXd& row) {
      const Eigen::VectorXf floats = row.cast<float>();
      file.write(reinterpret_cast<const char*>(floats.data()), floats.size() * 4);
    };
    write(measured_);
    write(nominal_);
    write(fitted_);
    for (Eigen::Index j = 0; j < jacobian_.cols(); ++j) write(jacobian_.col(j));
    Json shapes = Json::array();
    const SiteFacts facts = site_.facts();
    const auto list = list_candidates(site_);
    const Eigen::ArrayXXd base_kW = predictor_hours();
    const int days = site_.drivers->hours.back().day_index + 1;
    for (const Candidate& candidate : list.candidates) {
      for (const auto& own : shapes_to_try(candidate)) {
        const auto alteration = candidate.effect->bind(facts, own, candidate.meter);
        predictor_.parts_kW(theta_, alteration.get());
        const Eigen::ArrayXXd with_kW = predictor_.hours_kW();
        const auto note = [&](const Eigen::ArrayXXd& kW, double from, double to) {
          write(flat(reader_.read(kW)) - fitted_);
          shapes.push_back(
              {{"effect", candidate.key(site_)}, {"values", own}, {"from", from}, {"to", to}});
        };
        if (!candidate.begins) {
          note(with_kW, 0, days);
          continue;
        }
        constexpr int kStep = 56;
        for (int from = 28; from < days - 28; from += kStep) {
          std::vector<int> ends{days};
          if (candidate.ends) ends = {from + 56, from + 112, from + 196, days};
          for (const int to : ends) {
            if (to > days || (to == days && &to != &ends.back())) continue;
            Eigen::ArrayXXd kW = base_kW;
            for (Eigen::Index i = 0; i < kW.rows(); ++i) {
              const int day = site_.drivers->hours[static_cast<std::size_t>(i)].day_index;
              if (day >= from && day < to) kW.row(i) = with_kW.row(i);
            }
            note(kW, from, to);
          }
        }
      }
    }
    Json parameters = Json::array();
    for (std::size_t j = 0; j < site_.parameters.size(); ++j) {
      parameters.push_back(
          {{"name", site_.parameters[j].name}, {"score", scores_[static_cast<Eigen::Index>(j)]}});
    }
    const Json json{{"signatures", measured_.size()},
                    {"parameters", parameters},
                    {"objective", objective_},
                    {"runs", predictor_.runs()},
                    {"shapes", shapes}};
    std::ofstream(stem.string() + ".json") << json.dump();
  }

 private:
  Eigen::VectorXd run(const Eigen::VectorXd& scores) {
    theta_ = values_at(priors_, scores);
    predictor_.parts_kW(theta_);
    return flat(reader_.read(predictor_.hours_kW()));
  }
  Eigen::ArrayXXd predictor_hours() {
    predictor_.parts_kW(theta_);
    return predictor_.hours_kW();
  }
  double objective_of(const Eigen::VectorXd& at, const Eigen::VectorXd& scores) const {
    double sum = scores.squaredNorm();
    for (Eigen::Index i = 0; i < at.size(); ++i) {
      const double off = (measured_[i] - at[i]) / spread_[i];
      if (!std::isfinite(measured_[i]) || !std::isfinite(nominal_[i])) continue;
      // What vanishes, such as the start of a day without one, must not count as a good fit.
      sum += (std::isfinite(off) ? off * off : kVanished * kVanished) / kAlike;
    }
    return sum;
  }

  void fit() {
    priors_ = priors_of(site_);
    const auto q = static_cast<Eigen::Index>(priors_.size());
    scores_ = Eigen::VectorXd::Zero(q);
    fitted_ = nominal_ = run(scores_);
    objective_ = objective_of(fitted_, scores_);
    constexpr int kIterations = 5;
    for (int iteration = 0; iteration <= kIterations; ++iteration) {
      linearise();
      if (iteration == kIterations) break;
      Eigen::MatrixXd J = jacobian_;
      Eigen::VectorXd r = measured_ - fitted_ + jacobian_ * scores_;
      for (Eigen::Index i = 0; i < r.size(); ++i) {
        const double weight = 1.0 / (spread_[i] * std::sqrt(kAlike));
        if (std::isfinite(r[i])) {
          r[i] *= weight;
          J.row(i) *= weight;
        } else {
          r[i] = 0.0;
          J.row(i).setZero();
        }
      }
      const Eigen::MatrixXd normal = J.transpose() * J + Eigen::MatrixXd::Identity(q, q);
      const Eigen::VectorXd wanted =
          normal.llt().solve(J.transpose() * r).cwiseMax(-3.0).cwiseMin(3.0);
      double step = 1.0;
      bool is_better = false;
      for (int trial = 0; trial < 4 && !is_better; ++trial, step *= 0.4) {
        const Eigen::VectorXd there = scores_ + step * (wanted - scores_);
        const Eigen::VectorXd at = run(there);
        const double objective = objective_of(at, there);
        if (!(objective < objective_)) continue;
        is_better = true;
        scores_ = there;
        fitted_ = at;
        objective_ = objective;
      }
      if (!is_better) break;
    }
    run(scores_);
  }

  void linearise() {
    const Eigen::Index q = scores_.size();
    jacobian_.resize(measured_.size(), q);
    constexpr double kStep = 0.15;
    for (Eigen::Index j = 0; j < q; ++j) {
      Eigen::VectorXd there = scores_;
      const double step = there[j] > 0.0 ? -kStep : kStep;
      there[j] += step;
      jacobian_.col(j) = (run(there) - fitted_) / step;
      for (Eigen::Index i = 0; i < measured_.size(); ++i) {
        if (!std::isfinite(jacobian_(i, j))) jacobian_(i, j) = 0.0;
      }
    }
  }

  static constexpr double kAlike = 12.0;    // Signatures repeat each other.
  static constexpr double kVanished = 4.0;  // Of the spread.
  const SiteProblem& site_;
  SignatureReader reader_;
  Predictor predictor_;
  std::vector<Prior> priors_;
  Eigen::VectorXd spread_ = rough_spread();
  Eigen::VectorXd measured_, nominal_, fitted_, scores_;
  Eigen::MatrixXd jacobian_;
  std::vector<double> theta_;
  double objective_ = 0.0;
};

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Tabulates signatures of the cases of a population.", "signature_table"};
  fs::path population, out;
  std::string cases;
  app.add_option("--population", population, "folder that holds cases/")->required();
  app.add_option("--out", out, "folder for the tables")->required();
  app.add_option("--cases", cases, "only these, such as 1-20");
  CLI11_PARSE(app, argc, argv);
  fs::create_directories(out);
  std::ofstream(out / "names.json") << Json(signature_names()).dump(1);
  const auto listed = blind::cases_in(population / "cases");
  if (!listed) {
    std::cerr << listed.error().message << '\n';
    return 1;
  }
  const std::vector<std::string>& names = *listed;
  const auto range = blind::case_range_of(cases, names.size());
  if (!range) {
    std::cerr << fmt::format("--cases {}: give 1 to {}\n", cases, names.size());
    return 2;
  }
  for (std::size_t i = range->first - 1; i < range->last; ++i) {
    if (fs::exists(out / (names[i] + ".json"))) continue;
    const auto begin = std::chrono::steady_clock::now();
    auto site = daemon::open_site(population / "cases" / names[i] / "site.toml");
    if (!site) {
      std::cerr << names[i] << ": " << site.error().front() << '\n';
      continue;
    }
    if (const auto chosen = daemon::choose_model(site->config, ModelKind::hourly); !chosen) {
      std::cerr << names[i] << ": " << chosen.error().message << '\n';
      continue;
    }
    auto modelled = daemon::load_modelled_site(
        std::move(*site),
        std::chrono::floor<std::chrono::seconds>(std::chrono::system_clock::now()));
    if (!modelled) {
      std::cerr << names[i] << ": " << modelled.error().message << '\n';
      continue;
    }
    const auto problem = daemon::prepare_diagnosis(*modelled);
    if (!problem) {
      std::cerr << names[i] << ": " << problem.error().message << '\n';
      continue;
    }
    const auto loaded = std::chrono::steady_clock::now();
    Table(*problem).make(out / names[i]);
    const std::chrono::duration<double> load = loaded - begin;
    const std::chrono::duration<double> rest = std::chrono::steady_clock::now() - loaded;
    std::cout << fmt::format("{} {:.1f} s + {:.1f} s", names[i], load.count(), rest.count())
              << std::endl;
  }
  return 0;
}
