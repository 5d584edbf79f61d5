#include "kelemen.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>

#include "command.h"
#include "microlane/albedo.h"
#include "microlane/coupled.h"
#include "microlane/radial_table.h"
#include "microlane/rough_reflector.h"

namespace microlane {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kIncidences[] = {22.5, 45, 67.5};
constexpr float kMatteM = 0.8f, kIndex = 1.7f;

// What values of the plane's directions draw.
Curve Polar(const Plane& plane, const std::vector<float>& values, const std::string& title, int colour,
            bool dashed) {
  Curve curve{title, colour, dashed, {}, {}};
  for (std::size_t i = 0; i < plane.size(); ++i) {
    curve.x.push_back(static_cast<double>(values[i] * plane.x[i]));
    curve.y.push_back(static_cast<double>(values[i] * plane.z[i]));
  }
  return curve;
}

// f cos(theta_i), the radiance reflected of light of unit radiance a solid angle: by reciprocity, light and
// view change places.
template <class Eval, class Draw>
Curve Radiance(double incidence, const std::string& title, int colour, bool dashed, const Draw& draw,
               const Eval& eval) {
  const Plane plane(incidence);
  std::vector<float> values(plane.size());
  eval(plane.size(), plane.out(), plane.from(), values.data());
  return draw(plane, values, title, colour, dashed);
}

std::string Degrees(double incidence) { return fmt::format("{:g}°", incidence); }

void MeasureLobes(KelemenFigures& figures) {
  int colour = 0;
  for (const double incidence : kIncidences) {
    figures.lobes.push_back(
        Radiance(incidence, Degrees(incidence), colour, false, Polar,
                 [](std::size_t n, const Directions<float>& wi, const Directions<float>& wo, float* f_cos) {
                   rough_mirror_beckmann::EvalKelemen(n, wi, wo, {{0.1f, 0.1f}, {}}, f_cos, Accuracy::kHigh);
                 }));
    constexpr float kM = 0.3f;
    figures.cook_torrance.push_back(Radiance(
        incidence, "Cook-Torrance " + Degrees(incidence), colour, true, OverDegrees,
        [](std::size_t n, const Directions<float>& wi, const Directions<float>& wo, float* f_cos) {
          rough_conductor_beckmann::EvalVCavity(n, wi, wo, {{kM, kM}, {kIndex, 0}}, f_cos, Accuracy::kHigh);
        }));
    figures.cook_torrance.push_back(Radiance(
        incidence, "Kelemen " + Degrees(incidence), colour, false, OverDegrees,
        [](std::size_t n, const Directions<float>& wi, const Directions<float>& wo, float* f_cos) {
          rough_conductor_beckmann::EvalKelemen(n, wi, wo, {{kM, kM}, {kIndex, 0}}, f_cos, Accuracy::kHigh);
        }));
    ++colour;
  }
}

// Albedo over degrees from the normal.
Curve AlbedoCurve(const AlbedoTable& table, bool deficit, const std::string& title, int colour, bool dashed) {
  Curve curve{title, colour, dashed, {}, {}};
  std::vector<float> cosine;
  for (int i = 0; i < 180; ++i) {
    curve.x.push_back(0.5 * i);
    cosine.push_back(static_cast<float>(std::cos(0.5 * i * kDegree)));
  }
  std::vector<float> a(cosine.size()), rest(cosine.size());
  albedo::Directional(cosine.size(), cosine.data(), table, a.data(), rest.data(), Accuracy::kHigh);
  for (const float value : deficit ? rest : a) curve.y.push_back(static_cast<double>(value));
  return curve;
}

// The exponents of Phong are those of the same density of the half vector along the normal: n + 1 = 2/m^2.
void MeasureAlbedos(KelemenFigures& figures) {
  int colour = 0;
  for (const double m : {0.1, 0.3, 0.8}) {
    const struct {
      Normals normals;
      double roughness;
      const char* name;
    } lobes[] = {{Normals::kBeckmann, m, "Ward m"},
                 {Normals::kPhong, 2 / (m * m) - 2, "Phong n"},
                 {Normals::kGgx, m, "GGX alpha"}};
    int style = 0;
    for (const auto& of : lobes) {
      if (!(of.roughness >= 0)) continue;
      SpecularLobe lobe{of.normals, of.roughness};
      lobe.facets = Reflector::kMirror;
      const AlbedoTable table(lobe);
      const double shown = of.normals == Normals::kPhong ? of.roughness + 1 : of.roughness;
      figures.albedos.push_back(
          AlbedoCurve(table, false, fmt::format("{} = {:.3g}", of.name, shown), style, colour == 1));
      if (colour == 2) figures.albedos.back().title += " ";
      ++style;
    }
    ++colour;
  }
}

// The coupled model less its specular part.
std::vector<float> Matte(std::size_t n, const Directions<float>& wi, const Directions<float>& wo,
                         const AlbedoTable& table) {
  std::vector<double> from[6];
  const float* const components[] = {wi.x, wi.y, wi.z, wo.x, wo.y, wo.z};
  for (std::size_t k = 0; k < 6; ++k) from[k].assign(components[k], components[k] + n);
  const Directions<double> in{from[0].data(), from[1].data(), from[2].data()},
      out{from[3].data(), from[4].data(), from[5].data()};
  std::vector<double> both(n), specular(n);
  coupled::Eval(n, in, out, 1.0, table, both.data());
  const double m = static_cast<double>(kMatteM), index = static_cast<double>(kIndex);
  rough_conductor_beckmann::EvalKelemen(n, in, out, {{m, m}, {index, 0}}, specular.data());
  std::vector<float> matte(n);
  for (std::size_t i = 0; i < n; ++i) matte[i] = static_cast<float>(both[i] - specular[i]);
  return matte;
}

// Int f |cos(theta_o)| over the hemisphere of the coupled model of k, for light at `degrees` from the normal:
// midpoints of equal solid angles, two of them a step apart in azimuth.
double TotalAlbedo(const AlbedoTable& table, double k, double degrees) {
  constexpr int kHeights = 512, kAzimuths = 256;
  std::vector<double> wi_x, wi_z, wo_x, wo_y, wo_z;
  for (int i = 0; i < kHeights; ++i) {
    const double z = (i + 0.5) / kHeights, sine = std::sqrt(1 - z * z);
    for (int j = 0; j < kAzimuths; ++j) {
      const double phi = kPi * (j + 0.5) / kAzimuths;  // both halves are alike
      wo_x.push_back(sine * std::cos(phi));
      wo_y.push_back(sine * std::sin(phi));
      wo_z.push_back(z);
    }
  }
  const std::size_t n = wo_z.size();
  wi_x.assign(n, std::sin(degrees * kDegree));
  wi_z.assign(n, std::cos(degrees * kDegree));
  const std::vector<double> zero(n);
  std::vector<double> f_cos(n);
  coupled::Eval(n, Directions<double>{wi_x.data(), zero.data(), wi_z.data()},
                Directions<double>{wo_x.data(), wo_y.data(), wo_z.data()}, k, table, f_cos.data());
  double sum = 0;
  for (const double value : f_cos) sum += value;
  return sum * 2 * kPi / static_cast<double>(n);
}

void MeasureCoupled(KelemenFigures& figures) {
  const AlbedoTable table(WardLobe(static_cast<double>(kMatteM), static_cast<double>(kIndex)));
  int colour = 0;
  for (const double incidence : kIncidences) {
    const Plane plane(incidence);
    // f cos(theta_i) with the places changed; f itself is that over the cosine of what is fixed.
    std::vector<float> radiance = Matte(plane.size(), plane.out(), plane.from(), table);
    figures.matte_radiance.push_back(Polar(plane, radiance, Degrees(incidence), colour, false));
    for (float& value : radiance) value /= plane.from_z[0];
    figures.matte.push_back(Polar(plane, radiance, Degrees(incidence), colour, false));
    ++colour;
  }
  figures.coupled.push_back(AlbedoCurve(table, false, "specular", 0, false));
  figures.coupled.push_back(AlbedoCurve(table, true, "matte", 1, false));
  Curve total{"total, integrated", 3, true, {}, {}};
  for (double degrees = 0; degrees <= 87; degrees += 3) {
    total.x.push_back(degrees);
    total.y.push_back(TotalAlbedo(table, 1, degrees));
  }
  figures.coupled.push_back(total);
}

// The median of the times of several makings, in milliseconds.
template <class Make>
double MakingTime(const Make& make) {
  std::vector<double> times;
  for (int i = 0; i < 9; ++i) {
    const auto begin = std::chrono::steady_clock::now();
    make();
    times.push_back(
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count());
  }
  std::nth_element(times.begin(), times.begin() + 4, times.end());
  return times[4];
}

}  // namespace

KelemenFigures MeasureKelemen() {
  KelemenFigures figures;
  MeasureLobes(figures);
  MeasureAlbedos(figures);
  MeasureCoupled(figures);
  return figures;
}

std::vector<TableCost> MeasureAlbedoTables() {
  std::vector<SpecularLobe> lobes;
  for (const double m : {1e-4, 1e-3, 0.01, 0.03, 0.1, 0.3, 0.8, 2.0, 10.0}) lobes.push_back(WardLobe(m, 1.7));
  for (const double alpha : {0.03, 0.3, 1.0}) {
    lobes.push_back({Normals::kGgx, alpha, LobeMasking::kHeightCorrelated, Reflector::kMirror});
  }
  lobes.push_back({Normals::kPhong, 48});
  std::vector<TableCost> costs;
  for (const SpecularLobe& lobe : lobes) {
    const AlbedoTable table(lobe);
    if (!table.ok()) Fail(table.error());
    const char* const name = lobe.normals == Normals::kBeckmann ? "Ward m"
                             : lobe.normals == Normals::kGgx    ? "GGX mirror, Smith, alpha"
                                                                : "Phong exponent";
    TableCost cost{fmt::format("{} {:g}", name, lobe.roughness), table.bytes(), 0, 0};
    cost.ms = MakingTime([&] { const AlbedoTable made(lobe); });
    const AlbedoEntries& entries = table.entries();
    for (std::size_t j = 0; j < entries.last; ++j) {
      const double middle = 0.5 * (entries.Node(j) + entries.Node(j + 1));
      const double between =
          0.5 * (static_cast<double>(entries.albedo[j]) + static_cast<double>(entries.albedo[j + 1]));
      cost.error = std::max(cost.error, std::abs(between - DirectionalAlbedo(lobe, middle)));
    }
    costs.push_back(cost);
  }
  return costs;
}

std::vector<TableCost> MeasureRadialTables() {
  struct Named {
    std::string name;
    std::function<double(double)> f;
  };
  std::vector<Named> functions;
  for (const double gamma : {1.55, 2.0, 4.0, 50.0}) {
    functions.push_back({fmt::format("(1 + r^2/(g - 1))^-g, g = {:g}", gamma),
                         [gamma](double r) { return std::pow(1 + r * r / (gamma - 1), -gamma); }});
  }
  functions.push_back({"exp(-r^2)", [](double r) { return std::exp(-r * r); }});
  functions.push_back({"exp(-r)", [](double r) { return std::exp(-r); }});
  std::vector<TableCost> costs;
  for (const Named& named : functions) {
    const RadialTable table(named.f);
    if (!table.ok()) Fail(table.error());
    costs.push_back({named.name, table.bytes(), MakingTime([&] { const RadialTable made(named.f); }),
                     table.density_error(), table.masking_error(), table.sampling_error(),
                     table.visible_sampling_error()});
  }
  return costs;
}

void AddTables(CLI::App& app) {
  CLI::App* const tables = app.add_subcommand(
      "tables", "Error of the tables of albedo and of slopes against their size and making");
  tables->footer(
      "Of albedo: the largest error between the entries, against the quadrature. Of slopes (f(r) as named): "
      "relative "
      "errors that\nthe tables state, of D, of Lambda, and of the densities of sample_normal and "
      "sample_visible_normal.");
  tables->callback([] {
    fmt::print("{:36} {:>7} {:>7} {:>9}\n", "tables of albedo", "bytes", "ms", "error");
    for (const TableCost& cost : MeasureAlbedoTables()) {
      fmt::print("{:36} {:7} {:7.2f} {:9.1e}\n", cost.what, cost.bytes, cost.ms, cost.error);
    }
    fmt::print("\n{:36} {:>7} {:>7} {:>9} {:>9} {:>9} {:>9}\n", "tables of slopes", "bytes", "ms", "D",
               "Lambda", "sampling", "visible");
    for (const TableCost& cost : MeasureRadialTables()) {
      fmt::print("{:36} {:7} {:7.2f} {:9.1e} {:9.1e} {:9.1e} {:9.1e}\n", cost.what, cost.bytes, cost.ms,
                 cost.error, cost.masking, cost.sampling, cost.visible);
    }
  });
}

}  // namespace microlane
