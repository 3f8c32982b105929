#ifndef eunoe_tests_discovery_synthetic_h
#define eunoe_tests_discovery_synthetic_h

// A simulator whose models are known in closed form: several observables with scatter that is
// correlated within and between them, effects whose fingerprints resemble each other and bend with
// amplitude, runs that fail. It costs nothing, so that a discovery can be made hundreds of times.

#include "../tests.h"
#include "known_simulator.h"

namespace test {

struct ObservableShape
{
  std::string experiment, name;
  int size;
};

/// Properties of a synthetic simulator.
struct Nature
{
  std::uint32_t seed = 1; ///< of fingerprints and scatter
  unsigned int n_effects = 12;
  double power = 1.;             ///< of the amplitude, by which changes of effects of one sign grow
  double bend = 0.3;             ///< second-order change over the first-order one at one scale
  double alike = 0.6;            ///< share of fingerprints that stems from a few common patterns
  double strength_of_scale = 5.; ///< strength at an amplitude of one scale
  double seed_correlation = 0.3; ///< between runs of one seed at different amplitudes
  double failures = 0.02;        ///< share of runs that fail
  double refused_from = 1e9;     ///< positive amplitude of the first effect from which all fail
  std::string refused_in;        ///< the only experiment where they do; empty: everywhere
  std::string constant;          ///< observable that no run changes
  double skewness = 0.15;        ///< of the scatter
  double changed_chaos = 0.15;   ///< how much an effect at one scale makes scatter grow
  double swing = 0.5;            ///< common to all observables, in units of their own scatter
  unsigned int n_nuisances = 2;
  double nuisance_strength = 1.; ///< of one prior deviation
  std::vector<ObservableShape> observables = {{"spreading", "layer density", 6},
                                              {"spreading", "removed mass", 6},
                                              {"spreading", "profile", 20},
                                              {"spreading", "force", 1},
                                              {"heap", "angle", 1},
                                              {"heap", "profile", 12},
                                              {"heap", "mass", 1},
                                              {"thick layers", "layer density", 6},
                                              {"thick layers", "profile", 12},
                                              {"shear", "stress", 4}};
};

class SyntheticSimulator : public KnownSimulator
{
public:
  explicit SyntheticSimulator(const Nature &of) : nature(of)
  {
    for (const ObservableShape &shape : nature.observables) {
      if (all_points.count(shape.experiment) == 0)
        names.push_back(shape.experiment);
      for (int i = 0; i < shape.size; ++i)
        all_points[shape.experiment].push_back({shape.experiment, shape.name, i});
    }
    for (const std::string &name : names)
      make_chaos(name);
    for (unsigned int k = 0; k < nature.n_effects; ++k) {
      Factor f;
      f.name = std::string(1, static_cast<char>('a' + k));
      f.scale = 0.1 * (k + 1);
      f.lower = k % 4 == 3 ? -5. * f.scale : 0.;
      f.upper = 5. * f.scale;
      f.sign = k % 4 == 3 ? Factor::Sign::both : Factor::Sign::above;
      add_factor(f, k, nature.strength_of_scale, nature.alike);
    }
    for (unsigned int k = 0; k < nature.n_nuisances; ++k) {
      Factor f;
      f.kind = Factor::Kind::nuisance;
      f.name = "nuisance " + std::to_string(k);
      f.null_value = 1. + k;
      f.scale = f.prior_deviation = 0.1;
      f.lower = -10.;
      f.upper = 10.;
      f.sign = Factor::Sign::both;
      add_factor(f, 50 + k, nature.nuisance_strength, nature.alike);
    }
  }

  /// Makes the fingerprint of one effect equal to that of another, except for a share.
  void make_alike(const std::string &name, const std::string &other, double share,
                  const std::vector<std::string> &experiments)
  {
    for (const std::string &e : experiments) {
      Pattern &p = patterns[name][e];
      const Pattern &q = patterns[other][e];
      p.first = (1. - share) * q.first + share * p.first;
      p.second = (1. - share) * q.second + share * p.second;
    }
  }

  /// Makes an effect invisible in an experiment.
  void hide(const std::string &name, const std::string &experiment)
  {
    patterns[name][experiment].first.setZero();
    patterns[name][experiment].second.setZero();
  }

  Eigen::VectorXd mean(const std::string &experiment, const Amplitudes &amplitudes) const override
  {
    Eigen::VectorXd result = level.at(experiment);
    double crossed = 1.;
    for (const Factor &f : all_factors) {
      const auto found = amplitudes.find(f.name);
      if (found == amplitudes.end())
        continue;
      const double u = (found->second - f.null_value) / f.scale;
      const Pattern &p = patterns.at(f.name).at(experiment);
      const double first = f.sign == Factor::Sign::above ? std::pow(u, nature.power) : u;
      const double second = f.kind == Factor::Kind::nuisance ? 0. : u * std::abs(u);
      result += crossed * (first * p.first + second * p.second);
      crossed = 0.9; // effects weaken each other
    }
    return result;
  }

private:
  struct Pattern
  {
    Eigen::VectorXd first, second;
  };

  /// Smooth along each observable.
  Eigen::VectorXd smooth_pattern(const std::string &experiment, RandomStream &random) const
  {
    Eigen::VectorXd result(static_cast<Eigen::Index>(all_points.at(experiment).size()));
    Eigen::Index place = 0;
    for (const ObservableShape &shape : nature.observables) {
      if (shape.experiment != experiment)
        continue;
      const double a = random.normal(), b = random.normal(), c = random.normal();
      const double size = std::exp(0.7 * random.normal());
      for (int i = 0; i < shape.size; ++i) {
        const double x = shape.size > 1 ? double(i) / (shape.size - 1) : 0.;
        result(place++) = size * (a + b * (x - 0.5) + c * std::sin(M_PI * x));
      }
    }
    return result;
  }

  void make_chaos(const std::string &experiment)
  {
    RandomStream random(nature.seed, hash(experiment));
    const auto &list = all_points.at(experiment);
    const auto n = static_cast<Eigen::Index>(list.size());
    Eigen::MatrixXd correlation(n, n);
    for (Eigen::Index i = 0; i < n; ++i)
      for (Eigen::Index j = 0; j < n; ++j) {
        const DataPoint &a = list[static_cast<std::size_t>(i)],
                        &b = list[static_cast<std::size_t>(j)];
        correlation(i, j) = i == j                         ? 1.
                            : a.observable == b.observable ? std::pow(0.7, std::abs(i - j))
                                                           : 0.;
      }
    // A common swing of all observables on top.
    const Eigen::VectorXd swing = nature.swing * smooth_pattern(experiment, random);
    correlation += swing * swing.transpose();
    Eigen::VectorXd size(n);
    for (Eigen::Index i = 0; i < n; ++i)
      size(i) = std::exp(0.3 * random.normal());
    correlation = size.asDiagonal() * correlation * size.asDiagonal();
    half[experiment] = Eigen::LLT<Eigen::MatrixXd>(correlation).matrixL();
    level[experiment] = 20. * Eigen::VectorXd::Ones(n) + 3. * smooth_pattern(experiment, random);
  }

  void add_factor(const Factor &f, unsigned int number, double strength_of_scale, double alike)
  {
    constexpr unsigned int n_common = 4;
    all_factors.push_back(f);
    double square = 0.;
    for (const std::string &e : names) {
      RandomStream random(nature.seed, hash(e) + 1000u * (number + 1));
      Pattern p{smooth_pattern(e, random), smooth_pattern(e, random)};
      p.first *= 1. - alike;
      for (unsigned int l = 0; l < n_common; ++l) {
        RandomStream shared(nature.seed, hash(e) + 17u + l);
        RandomStream weights(nature.seed, 900u + 10u * number + l);
        p.first += alike * weights.normal() * smooth_pattern(e, shared);
      }
      const auto &h = half.at(e).triangularView<Eigen::Lower>();
      p.second *= nature.bend * h.solve(p.first).norm() / h.solve(p.second).norm();
      if (e == "spreading" || e == "heap")
        square += h.solve(p.first + p.second).squaredNorm();
      patterns[f.name][e] = p;
    }
    for (auto &[e, p] : patterns[f.name]) {
      p.first *= strength_of_scale / std::sqrt(square);
      p.second *= strength_of_scale / std::sqrt(square);
    }
  }

  Eigen::VectorXd value(const std::string &experiment, const Amplitudes &amplitudes,
                        std::uint32_t seed) const override
  {
    std::string text;
    double growth = 1.;
    for (const Factor &f : all_factors) {
      const auto found = amplitudes.find(f.name);
      if (found == amplitudes.end() || found->second == f.null_value)
        continue;
      text += f.name + std::to_string(found->second);
      if (f.kind == Factor::Kind::effect)
        growth += nature.changed_chaos * std::abs(found->second - f.null_value) / f.scale *
                  (f.name[0] % 2 == 0 ? 1. : -0.3);
    }
    RandomStream common(seed, hash(experiment)), own(seed, hash(experiment) ^ hash(text + "|"));
    const auto n = static_cast<Eigen::Index>(all_points.at(experiment).size());
    Eigen::VectorXd z(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      z(i) = std::sqrt(nature.seed_correlation) * common.normal() +
             std::sqrt(1. - nature.seed_correlation) * own.normal();
      z(i) += nature.skewness * (z(i) * z(i) - 1.);
      z(i) /= std::sqrt(1. + 2. * nature.skewness * nature.skewness);
    }
    Eigen::VectorXd result =
        mean(experiment, amplitudes) + std::max(0.5, growth) * (half.at(experiment) * z);
    for (Eigen::Index i = 0; i < n; ++i)
      if (all_points.at(experiment)[static_cast<std::size_t>(i)].observable == nature.constant)
        result(i) = level.at(experiment)(i);
    return result;
  }

  bool fails(const RunRequest &request) const override
  {
    const auto first = request.amplitudes.find("a");
    if (first != request.amplitudes.end() && first->second >= nature.refused_from &&
        (nature.refused_in.empty() || nature.refused_in == request.experiment))
      return true;
    std::string text = request.experiment;
    for (const auto &[name, amplitude] : request.amplitudes)
      text += name + std::to_string(amplitude);
    return RandomStream(request.seed, hash(text) + 5u).uniform() < nature.failures;
  }

  const Nature nature;
  std::vector<std::string> names;
  std::map<std::string, Eigen::VectorXd> level;
  std::map<std::string, std::map<std::string, Pattern>> patterns;
};

} // namespace test

#endif
