// SPDX-License-Identifier: LGPL-2.1-or-later
#include "oracles.h"

#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <boost/math/tools/roots.hpp>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>

namespace oracle {
namespace {

using Function = std::function<double(double)>;

double integrate(const Function& f, double a, double b) {
  if (a == b) return 0;
  return boost::math::quadrature::gauss_kronrod<double, 61>::integrate(f, a, b, 7, 1e-13);
}

double root(const Function& f, double a, double b) {
  std::uintmax_t iterations = 200;
  const auto bracket = boost::math::tools::toms748_solve(
      f, a, b, boost::math::tools::eps_tolerance<double>(52), iterations);
  return (bracket.first + bracket.second) / 2;
}

/// sin θ from g = sin θ + ½ F β sin² θ, without cancellation; 2 where there is none.
double sine(double g, double F_beta) {
  const double discriminant = 1 + 2 * F_beta * g;
  return discriminant < 0 ? 2 : 2 * g / (1 + std::sqrt(discriminant));
}

}  // namespace

Tip cantilever(double L, double EI, double one_over_EA, double one_over_kGA, double F) {
  const double beta = one_over_EA - one_over_kGA;
  // u² = sin θ_L − sin θ takes the square-root singularity at the tip away; with c² = 1 − sin θ_L,
  // cos θ = √((c² + u²)(1 + sin θ)) does not cancel.
  const auto along = [&](double theta_L, const Function& integrand) {
    const double sL = std::sin(theta_L);
    const double c2 = 2 * std::pow(std::sin((std::numbers::pi / 2 - theta_L) / 2), 2);
    const auto f = [&](double u) {
      const double s = sL - u * u;
      const double cosine = std::sqrt((c2 + u * u) * (1 + s));
      const double rate = std::sqrt(2 * F / EI * (1 + 0.5 * F * beta * (sL + s)));  // θ'/u
      return integrand(s) * 2 / (cosine * rate);
    };
    return integrate(f, 0, std::sqrt(sL));
  };
  const auto length = [&](double theta_L) {
    return along(theta_L, [](double) { return 1.0; }) - L;
  };
  const double theta = root(length, 1e-8, std::numbers::pi / 2 - 1e-9);
  const double x = along(theta, [&](double s) {
    return (1 + F * s * one_over_EA) * s + F * one_over_kGA * (1 - s * s);
  });
  const double z =
      along(theta, [&](double s) { return std::sqrt(1 - s * s) * (1 + F * beta * s); });
  return {x, z, theta};
}

Contact contact(const std::vector<Stretch>& beam, double F, double h) {
  double S = 0;
  double x = 0;
  double z = 0;
  double s = 0;  // sin θ
  double remaining = 0;
  double theta_contact = 0;
  for (const Stretch& stretch : beam) {
    if (z >= h) {
      remaining += stretch.length;
      continue;
    }
    const double Fb = F * stretch.beta;
    const double z0 = z;
    const double g0 = s + 0.5 * Fb * s * s;
    const auto sine_at = [&](double height) {
      return sine(g0 + F * (height - z0) * (2 * h - height - z0) / (2 * stretch.EI), Fb);
    };
    const auto slope = [&](double height) {  // z'
      const double sn = sine_at(height);
      return std::sqrt(1 - sn * sn) * (1 + Fb * sn);
    };
    const auto arclength = [&](double height) {
      return integrate([&](double y) { return 1 / slope(y); }, z0, height);
    };
    double z1 = h;
    if (sine_at(h) >= 1 || arclength(h) > stretch.length) {
      const double limit =
          sine_at(h) < 1 ? h : root([&](double y) { return sine_at(y) - 1; }, z0, h);
      const double top = z0 + (limit - z0) * (1 - 1e-12);
      // Bent to the horizontal below h: no stretch, however long, would reach the contact.
      if (arclength(top) < stretch.length) return {1e3 * h, {}};
      z1 = root([&](double y) { return arclength(y) - stretch.length; }, z0, top);
      S += stretch.length;
    } else {
      S += arclength(h);
      remaining += stretch.length - arclength(h);
    }
    x += integrate(
        [&](double y) {
          const double sn = sine_at(y);
          const double across =
              (1 + F * sn * stretch.one_over_EA) * sn + F * stretch.one_over_kGA * (1 - sn * sn);
          return across / slope(y);
        },
        z0, z1);
    s = sine_at(z1);
    z = z1;
    theta_contact = std::asin(s);
  }
  return {S,
          {x + remaining * std::sin(theta_contact), z + remaining * std::cos(theta_contact),
           theta_contact}};
}

double slip_off_force(const std::vector<Stretch>& beam, double h) {
  // The rod above the contact plays no part: with the last stretch made long, the contact's arc
  // length is a smooth function of F, and slip-off is where it is L.
  double L = 0;
  for (const Stretch& stretch : beam) L += stretch.length;
  std::vector<Stretch> extended = beam;
  extended.back().length *= 100;
  const auto excess = [&](double F) { return contact(extended, F, h).arclength - L; };
  double high = 1e-3 * beam.front().EI / (h * h);
  while (excess(high) < 0) high *= 1.1;
  return root(excess, high / 1.1, high);
}

Tip flow(const std::vector<Stretch>& beam, double q) {
  double L = 0;
  for (const Stretch& stretch : beam) L += stretch.length;
  Tip tip{};
  // Height reached by the whole arc length, for a supposed height z₂ of the tip.
  const auto march = [&](double z2) {
    tip = {};
    double s = 0;
    for (const Stretch& stretch : beam) {
      const double z0 = tip.z;
      const double s0 = s;
      const auto sine_at = [&](double y) {
        return s0 + q / (6 * stretch.EI) * (std::pow(z2 - z0, 3) - std::pow(z2 - y, 3));
      };
      const auto arclength = [&](double y) {
        return integrate([&](double v) { return 1 / std::sqrt(1 - std::pow(sine_at(v), 2)); }, z0,
                         y);
      };
      double limit = z0 + stretch.length;
      if (sine_at(limit) >= 1) limit = root([&](double y) { return sine_at(y) - 1; }, z0, limit);
      limit = z0 + (limit - z0) * (1 - 1e-12);
      if (arclength(limit) <= stretch.length) limit = z0 + stretch.length;
      const double z1 =
          arclength(limit) <= stretch.length
              ? limit
              : root([&](double y) { return arclength(y) - stretch.length; }, z0, limit);
      tip.x += integrate(
          [&](double y) { return sine_at(y) / std::sqrt(1 - std::pow(sine_at(y), 2)); }, z0, z1);
      tip.z = z1;
      s = sine_at(z1);
    }
    tip.theta = std::asin(s);
    return tip.z - z2;
  };
  const double z2 = root(march, 1e-3 * L, L);
  march(z2);
  return tip;
}

}  // namespace oracle
