// Diameters drawn from every distribution have the prescribed shares, means and cut-offs.

#include <eunoe/core/random.h>

#include "../tests.h"

#include <cstdio>
#include <fstream>
#include <map>
#include <sstream>

using namespace test;

namespace {

constexpr unsigned int n = 200000;

/// Reads further entries, as an input file has them.
void set(SizeDistributionParameters &parameters, const std::string &entries)
{
  read_entries([&](dealii::ParameterHandler &prm) { parameters.declare(prm); }, entries);
}

std::vector<double> draw(const SizeDistributionParameters &parameters)
{
  const auto distribution = parameters.make();
  std::vector<double> diameters;
  for (unsigned int id = 0; id < n; ++id)
    diameters.push_back(distribution->diameter(uniform(parameters.seed, Draw::size, id)));
  return diameters;
}

double mean_power(const std::vector<double> &values, double power)
{
  double sum = 0.;
  for (const double value : values)
    sum += std::pow(value, power);
  return sum / values.size();
}

/// The paper's classes: shares of the volume.
void test_classes()
{
  SizeDistributionParameters p;
  p.type = "custom";
  p.basis = "volume";
  const std::vector<double> classes = {52.6220e-6, 57.7666e-6, 63.4141e-6, 69.6138e-6,
                                       76.4196e-6, 83.8907e-6, 92.0923e-6, 101.0960e-6};
  const std::vector<double> fractions = {0.146168, 0.168842, 0.168577, 0.152019,
                                         0.129519, 0.105404, 0.078927, 0.050544};
  set(p, "set custom diameters = 52.6220e-6, 57.7666e-6, 63.4141e-6, 69.6138e-6, 76.4196e-6, "
         "83.8907e-6, 92.0923e-6, 101.0960e-6\n"
         "set custom distribution diameters probabilities = 0.146168, 0.168842, 0.168577, "
         "0.152019, 0.129519, 0.105404, 0.078927, 0.050544\n");
  const auto diameters = draw(p);
  std::map<double, double> volume;
  double total = 0.;
  for (const double d : diameters) {
    volume[d] += d * d * d;
    total += d * d * d;
  }
  bool all = volume.size() == classes.size();
  for (std::size_t c = 0; c < classes.size(); ++c) {
    const double share = volume[classes[c]] / total;
    // Four standard errors of a count of that many particles, as a share of the volume.
    const double count = volume[classes[c]] / std::pow(classes[c], 3);
    all = all && std::abs(share - fractions[c]) < 4. * fractions[c] / std::sqrt(count) + 1e-5;
  }
  check("volume shares of the classes", all);
  check_relative("mean cube", mean_power(diameters, 3.), p.make()->mean_cube(), 5e-3);

  p.basis = "number";
  double first = 0.;
  for (const double d : draw(p))
    first += d == classes[0] ? 1. : 0.;
  check_close("number shares of the classes", first / n, fractions[0], 4. * 0.36 / std::sqrt(n));
}

void test_normal()
{
  SizeDistributionParameters p;
  p.type = "normal";
  p.average_diameter = 70e-6;
  p.standard_deviation = 10e-6;
  const auto diameters = draw(p);
  const double mean = mean_power(diameters, 1.);
  // Variance of a normal distribution cut at 2.5 deviations: 1 - 5 phi(2.5) / (2 Phi(2.5) - 1).
  const double phi = std::exp(-0.5 * 2.5 * 2.5) / std::sqrt(2. * M_PI);
  const double variance = 1. - 5. * phi / std::erf(2.5 / std::sqrt(2.));
  check_close("normal: mean", 1e6 * mean, 70., 5. * 10. / std::sqrt(n));
  check_relative("normal: variance", mean_power(diameters, 2.) - mean * mean, variance * 1e-10,
                 0.02);
  check_close("normal: smallest", 1e6 * p.make()->smallest(), 45., 1e-9);
  check_close("normal: largest", 1e6 * p.make()->largest(), 95., 1e-9);
  check_relative("normal: mean cube", mean_power(diameters, 3.), p.make()->mean_cube(), 5e-3);
}

/// By volume, a lognormal distribution is again lognormal, with its logarithm shifted by three
/// variances.
void test_lognormal()
{
  SizeDistributionParameters p;
  p.type = "lognormal";
  p.average_diameter = 70e-6;
  p.standard_deviation = 14e-6;
  p.smallest = 10e-6;
  p.largest = 400e-6;
  const double sigma2 = std::log(1. + 0.2 * 0.2);
  const auto log_mean = [](const std::vector<double> &diameters) {
    double sum = 0.;
    for (const double d : diameters)
      sum += std::log(d);
    return sum / diameters.size();
  };
  const double mu = std::log(70e-6) - 0.5 * sigma2;
  const double error = 5. * std::sqrt(sigma2 / n);
  check_close("lognormal: mean of the logarithm", log_mean(draw(p)), mu, error);
  check_relative("lognormal: mean", mean_power(draw(p), 1.), 70e-6, 3e-3);
  p.basis = "volume";
  check_close("lognormal by volume", log_mean(draw(p)), mu - 3. * sigma2, error);
  p.weighting_exponent = 2.;
  check_close("lognormal, weighted", log_mean(draw(p)), mu - sigma2, error);
}

/// Shares of the volume that are weighted with the cube of the diameter are shares of the number.
void test_weighting()
{
  SizeDistributionParameters p;
  p.type = "custom";
  const double smaller = 50e-6;
  set(p, "set custom diameters = 50e-6, 100e-6\n"
         "set custom distribution diameters probabilities = 0.3, 0.7\n");
  const auto by_number = draw(p);
  p.basis = "volume";
  p.weighting_exponent = 3.;
  check("volume weighted to number", draw(p) == by_number);
  check_relative("mean cube, weighted", p.make()->mean_cube(), 0.3 * 1.25e-13 + 0.7 * 1e-12, 1e-12);
  p.weighting_exponent = -2.;
  double small = 0.;
  for (const double d : draw(p))
    small += d == smaller ? 1. : 0.;
  // The shares of the number are the given shares times the diameter to the power -5.
  const double share = 0.3 * 32. / (0.3 * 32. + 0.7);
  check_close("more fines", small / n, share, 4. * std::sqrt(share * (1. - share) / n));
}

/// A table in a file, in every form that it may have. Reference: its integrals.
void test_tables()
{
  {
    std::ofstream stream("sizes.txt");
    stream << "diameter; cumulative\n40e-6; 0.2\n60e-6; 0.5\n\n100e-6; 1\n";
  }
  SizeDistributionParameters p;
  p.type = "custom";
  set(p, "set custom distribution from file = true\n"
         "set custom distribution filename = sizes.txt\n"
         "set custom distribution probability function type = CDF\n");
  p.read_files([](const std::string &file) {
    std::ostringstream text;
    text << std::ifstream(file).rdbuf();
    return text.str();
  });
  std::remove("sizes.txt"); // what was read belongs to the parameters
  const auto share_below = [&p](double d) {
    double below = 0.;
    for (const double drawn : draw(p))
      below += drawn <= d ? 1. / n : 0.;
    return below;
  };
  const double error = 4. * 0.5 / std::sqrt(n);
  check_close("CDF: classes", share_below(60e-6), 0.5, error);
  check("CDF: nothing between the classes", share_below(99e-6) == share_below(60e-6));

  set(p, "set custom distribution interpolation = true\n");
  // Half of the share between 60 and 100 um.
  check_close("interpolated: between diameters", share_below(80e-6), 0.75, error);
  check_close("interpolated: the first share at its diameter", share_below(40e-6), 0.2, error);
  // Mean cubes over an interval: (b^4 - a^4) / 4 / (b - a).
  const auto cube = [](double a, double b) {
    return (std::pow(b, 4) - std::pow(a, 4)) / 4. / (b - a);
  };
  const double by_number =
      0.2 * std::pow(40e-6, 3) + 0.3 * cube(40e-6, 60e-6) + 0.5 * cube(60e-6, 100e-6);
  check_relative("interpolated: mean cube", p.make()->mean_cube(), by_number, 1e-4);

  p.basis = "volume";
  // The number of a share of the volume v: v times the mean of d^-3, (a^-2 - b^-2) / 2 / (b - a).
  const auto number = [](double a, double b) {
    return (std::pow(a, -2) - std::pow(b, -2)) / 2. / (b - a);
  };
  const double all =
      0.2 * std::pow(40e-6, -3) + 0.3 * number(40e-6, 60e-6) + 0.5 * number(60e-6, 100e-6);
  check_relative("interpolated by volume: mean cube", p.make()->mean_cube(), 1. / all, 1e-4);
  check_close("interpolated by volume: share of the finest", share_below(40e-6),
              0.2 * std::pow(40e-6, -3) / all, error);

  p.basis = "number";
  p.smallest = 50e-6;
  p.largest = 80e-6;
  // Left are 0.15 up to 60 um and 0.25 above.
  check_close("cut-offs", share_below(60e-6), 0.15 / 0.4, error);
  check("cut-offs: smallest and largest",
        p.make()->smallest() == 50e-6 && p.make()->largest() == 80e-6);
  set(p, "set custom distribution interpolation = false\n");
  check("cut-offs of classes", share_below(60e-6) > 0.9999);

  SizeDistributionParameters step;
  step.type = "custom";
  set(step, "set custom distribution diameters values = 20e-6, 20e-6, 40e-6\n"
            "set custom distribution diameters probabilities = 0, 0.3, 1\n"
            "set custom distribution probability function type = CDF\n"
            "set custom distribution interpolation = true\n");
  double finest = 0.;
  for (const double drawn : draw(step))
    finest += drawn <= 20e-6 ? 1. / n : 0.;
  check_close("interpolated: a step of the CDF", finest, 0.3, error);
}

/// Diameters without a share at the ends of a table are no sizes, and without them the same random
/// numbers give the same diameters.
void test_empty_ends()
{
  const auto table = [](const std::string &diameters, const std::string &shares,
                        const std::string &more) {
    SizeDistributionParameters p;
    p.type = "custom";
    set(p, "set custom distribution diameters values = " + diameters +
               "\nset custom distribution diameters probabilities = " + shares + "\n" + more);
    return p;
  };
  const auto ends = [](const SizeDistributionParameters &p, double smallest, double largest) {
    return p.make()->smallest() == smallest && p.make()->largest() == largest;
  };
  const std::string interpolated = "set custom distribution interpolation = true\n",
                    cdf = "set custom distribution probability function type = CDF\n";
  const std::string four = "10e-6, 20e-6, 30e-6, 40e-6", pdf = "0, 0.3, 0.7, 0";
  check("empty classes are no sizes", ends(table(four, pdf, ""), 20e-6, 30e-6));
  check("and change no draw",
        draw(table(four, pdf, "")) == draw(table("20e-6, 30e-6", "0.3, 0.7", "")));
  check("empty pieces are no sizes", ends(table(four, pdf, interpolated), 10e-6, 30e-6));
  check("and change no draw either",
        draw(table(four, pdf, interpolated)) ==
            draw(table("10e-6, 20e-6, 30e-6", "0, 0.3, 0.7", interpolated)));
  const std::string five = four + ", 50e-6", sums = "0, 0, 0.3, 1, 1";
  check("nor empty classes of a CDF", ends(table(five, sums, cdf), 30e-6, 40e-6));
  check("nor its empty pieces", ends(table(five, sums, cdf + interpolated), 20e-6, 40e-6));
}

} // namespace

EUNOE_TEST()
{
  test_classes();
  test_normal();
  test_lognormal();
  test_weighting();
  test_tables();
  test_empty_ends();
  SizeDistributionParameters p;
  p.average_diameter = 1e-3;
  check("uniform", draw(p).front() == 1e-3 && draw(p).back() == 1e-3);
}
