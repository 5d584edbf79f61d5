#include "cavity_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "microlane/scalar/beckmann.h"
#include "microlane/scalar/fresnel.h"
#include "microlane/scalar/ggx.h"

namespace microlane {
namespace {

constexpr double kPi = 3.14159265358979323846;
using Vec3 = scalar::Vec3<double>;

double Number(std::size_t n) { return static_cast<double>(n); }

// The mean of f over a cell, by the cosine, of a number of paths that left through it.
double MeanBrdf(const CavityResult& result, std::size_t row, double paths) {
  const double cos = (Number(row) + 0.5) / Number(result.scene.rows);
  const double solid_angle = 2 * kPi / Number(result.scene.rows * result.scene.columns);
  return paths / (static_cast<double>(result.paths) * solid_angle * cos);
}

// Of one order, or of all behind the last.
std::uint64_t Count(const CavityResult& result, std::size_t order, std::size_t row, std::size_t column) {
  const std::size_t cells = result.scene.rows * result.scene.columns,
                    at = row * result.scene.columns + column;
  if (order < result.scene.orders) return result.counts[order * cells + at];
  std::uint64_t sum = 0;
  for (std::size_t j = 0; j < result.scene.orders; ++j) sum += result.counts[j * cells + at];
  return sum;
}

// The first bounce: Meneveaux 2015 Eqs. 2, 8 with the masking of Torrance and Sparrow (Eq. 14), the body by
// the trapezoidal rule in the logarithm of the slope and its azimuth.
class SingleBounce {
 public:
  SingleBounce(const VCavityScene& scene, bool ggx)
      : scene_(scene), ggx_(ggx), i_(Normalized({scene.wi[0], scene.wi[1], scene.wi[2]})) {}

  double Value(const Vec3& o) const {
    const Vec3 h = Normalized(i_ + o);
    const bool mirror = scene_.facets == VCavityFacets::kMirror;
    const double reflectance =
        mirror ? 1 : scalar::FresnelDielectric<double>(scalar::Square(Dot(i_, h)), scene_.n_i).Reflectance();
    const double surface = reflectance * D(h) * Masking(o, h) / (4 * i_.z * o.z);
    return mirror || scene_.k == 0 ? surface : surface + Body(o);
  }

 private:
  static Vec3 Normalized(const Vec3& v) { return v / std::sqrt(Dot(v, v)); }
  double D(const Vec3& m) const {
    return ggx_ ? scalar::Ggx<double>{scene_.alpha_x, scene_.alpha_y}.D(m)
                : scalar::Beckmann<double>{scene_.alpha_x, scene_.alpha_y}.D(m);
  }
  double Masking(const Vec3& o, const Vec3& m) const {
    return std::min({1.0, 2 * m.z * i_.z / Dot(i_, m), 2 * m.z * o.z / Dot(o, m)});
  }
  double Body(const Vec3& o) const {
    constexpr double kStep = 0.2, kEnd = 10;
    constexpr int kAzimuths = 64;
    const auto transmittance = [&](double cos) {
      return scalar::FresnelDielectric<double>(cos * cos, scene_.n_i).Transmittance();
    };
    double sum = 0;
    for (double log_r = -kEnd; log_r < kEnd; log_r += kStep) {
      const double r = std::exp(log_r);
      for (int j = 0; j < kAzimuths; ++j) {
        const double phi = (j + 0.5) * 2 * kPi / kAzimuths;
        const double x = scene_.alpha_x * r * std::cos(phi), y = scene_.alpha_y * r * std::sin(phi);
        const double z = 1 / std::sqrt(1 + x * x + y * y);
        const Vec3 m{x * z, y * z, z};
        const double cos_i = Dot(i_, m), cos_o = Dot(o, m);
        if (cos_i <= 0 || cos_o <= 0) continue;
        const double solid_angle =
            scene_.alpha_x * scene_.alpha_y * r * r * kStep * 2 * kPi / kAzimuths * z * z * z;
        sum +=
            transmittance(cos_i) * transmittance(cos_o) * cos_i * cos_o * D(m) * Masking(o, m) * solid_angle;
      }
    }
    return sum * scalar::BodyAlbedo<double>(scene_.n_i, scene_.k) / (kPi * i_.z * o.z);
  }

  const VCavityScene& scene_;
  bool ggx_;
  Vec3 i_;
};

// Rows' mean angles from the normal on wi's side, negative, and on the other, and the columns that they are
// in.
struct PlanePoint {
  double degrees, azimuth;
  std::size_t row, column;
};
std::vector<PlanePoint> PlaneOfIncidence(const VCavityScene& scene) {
  std::vector<PlanePoint> points;
  const double phi = std::atan2(scene.wi[1], scene.wi[0]);
  for (const bool behind : {false, true}) {
    const double azimuth = phi + (behind ? kPi : 0);
    const double turns = azimuth / (2 * kPi) - std::floor(azimuth / (2 * kPi));
    const std::size_t column =
        std::min(static_cast<std::size_t>(turns * Number(scene.columns)), scene.columns - 1);
    for (std::size_t j = 0; j < scene.rows; ++j) {
      const std::size_t row = behind ? scene.rows - 1 - j : j;
      const double degrees = std::acos((Number(row) + 0.5) / Number(scene.rows)) * 180 / kPi;
      points.push_back({behind ? degrees : -degrees, (Number(column) + 0.5) * 2 * kPi / Number(scene.columns),
                        row, column});
    }
  }
  return points;
}

std::string LobesPanel(const CavityResult& result, bool ggx) {
  constexpr const char* kColours[] = {"#1f6fb2", "#2e9e4f", "#e08214", "#9467bd", "#8c564b", "#7f7f7f"};
  const std::vector<PlanePoint> plane = PlaneOfIncidence(result.scene);
  std::string data, plot;
  for (std::size_t order = 0; order <= result.scene.orders; ++order) {
    const bool all = order == result.scene.orders;
    data += fmt::format("$h{} << EOD\n", order);
    for (const PlanePoint& p : plane) {
      const double count = static_cast<double>(Count(result, order, p.row, p.column));
      data += fmt::format("{:.3f} {:.6g}\n", p.degrees, MeanBrdf(result, p.row, count));
    }
    data += "EOD\n";
    const std::string name = all ? "all" : HitsName(result.scene, order);
    plot += fmt::format(
        "{}$h{} using 1:2 with lines lw 2 lc rgb '{}' title '{} {}'", order == 0 ? "plot " : ", ", order,
        all ? "#c0392b" : kColours[order % std::size(kColours)], name, name == "1" ? "hit" : "hits");
  }
  const SingleBounce single(result.scene, ggx);
  data += "$analytic << EOD\n";
  for (const PlanePoint& p : plane) {
    const double theta = std::abs(p.degrees) * kPi / 180;
    const Vec3 o{std::sin(theta) * std::cos(p.azimuth), std::sin(theta) * std::sin(p.azimuth),
                 std::cos(theta)};
    data += fmt::format("{:.3f} {:.6g}\n", p.degrees, single.Value(o));
  }
  data += "EOD\n";
  plot += ", $analytic using 1:2 with points pt 6 ps 0.5 lc rgb '#222222' title 'analytic, 1 hit'\n";
  return data +
         "set title 'In the plane of incidence'\nset xlabel 'degrees from the normal, light from the left'\n"
         "set ylabel 'f, 1/sr'\nset xrange [-90:90]\nset xtics 30\nset yrange [0:*]\n"
         "set grid xtics ytics lt 1 lw 0.5 lc rgb '#dddddd'\nset key below horizontal Left reverse\n" +
         plot;
}

// Cells as they are seen from above, each of the same area.
std::string HemispherePanel(const CavityResult& result) {
  const VCavityScene& scene = result.scene;
  std::string data = "$cells << EOD\n";
  for (std::size_t row = 0; row <= scene.rows; ++row) {
    const double r = std::sqrt(1 - Number(row) / Number(scene.rows));
    for (std::size_t column = 0; column <= scene.columns; ++column) {
      const double phi = Number(column) * 2 * kPi / Number(scene.columns);
      const std::size_t inside_row = std::min(row, scene.rows - 1);
      const double count =
          static_cast<double>(Count(result, scene.orders, inside_row, column % scene.columns));
      data += fmt::format("{:.5f} {:.5f} {:.5g}\n", r * std::cos(phi), r * std::sin(phi),
                          MeanBrdf(result, inside_row, count));
    }
    data += "\n";
  }
  data += "EOD\n";
  const double length = std::hypot(scene.wi[0], scene.wi[1], scene.wi[2]);
  const double across = std::hypot(scene.wi[0], scene.wi[1]), r = std::sqrt(1 - scene.wi[2] / length);
  const double x = across == 0 ? 0 : r * scene.wi[0] / across, y = across == 0 ? 0 : r * scene.wi[1] / across;
  return data +
         fmt::format(
             "unset grid\nunset key\nset title 'f of all hits on the hemisphere, 1/sr; x: light'\n"
             "set xrange [-1.05:1.05]\nset yrange [-1.05:1.05]\nunset xtics\nunset ytics\nunset xlabel\n"
             "unset ylabel\nunset border\nset size ratio -1\nset pm3d map corners2color c1\n"
             "set palette defined (0 '#0d1b2a', 0.3 '#1f6fb2', 0.65 '#8fd0c0', 1 '#fff3b0')\n"
             "set cbrange [0:*]\nset label 1 'x' at {:.4f}, {:.4f} center front tc rgb '#c0392b'\n"
             "splot $cells using 1:2:3 with pm3d\n",
             x, y);
}

}  // namespace

std::string HitsName(const VCavityScene& scene, std::size_t order) {
  return fmt::format("{}{}", order + 1, order + 1 == scene.orders ? "+" : "");
}

std::uint64_t CountOfHits(const CavityResult& result, std::size_t order) {
  const std::size_t cells = result.scene.rows * result.scene.columns;
  std::uint64_t sum = 0;
  for (std::size_t j = 0; j < cells; ++j) sum += result.counts[order * cells + j];
  return sum;
}

void WriteCavityCsv(const CavityResult& result, const std::string& title, std::ostream& out) {
  const VCavityScene& scene = result.scene;
  out << fmt::format("# V-cavities of {}: {} paths, seed {}\n", title, result.paths, scene.seed)
      << "hits,row,column,cos_low,cos_high,azimuth_low,azimuth_high,paths,f,f_error\n";
  for (std::size_t order = 0; order <= scene.orders; ++order) {
    const std::string name = order == scene.orders ? "all" : HitsName(scene, order);
    for (std::size_t row = 0; row < scene.rows; ++row) {
      for (std::size_t column = 0; column < scene.columns; ++column) {
        const double count = static_cast<double>(Count(result, order, row, column));
        const double deviation = std::sqrt(count * (1 - count / static_cast<double>(result.paths)));
        out << fmt::format("{},{},{},{:.6g},{:.6g},{:.6g},{:.6g},{},{:.6g},{:.3g}\n", name, row, column,
                           Number(row) / Number(scene.rows), Number(row + 1) / Number(scene.rows),
                           360 * Number(column) / Number(scene.columns),
                           360 * Number(column + 1) / Number(scene.columns), count,
                           MeanBrdf(result, row, count), MeanBrdf(result, row, deviation));
      }
    }
  }
}

std::string PictureTerminal(const std::string& name) {
  const std::string end = name.size() > 4 ? name.substr(name.size() - 4) : "";
  return end == ".svg"   ? "svg size 1000,440 dynamic font 'sans-serif,13' background '#ffffff'"
         : end == ".png" ? "pngcairo size 1000,440 font 'sans-serif,11'"
                         : "";
}

std::string CavityScript(const CavityResult& result, const std::string& title, bool ggx) {
  return fmt::format("set multiplot layout 1, 2 title '{}'\n", title) + LobesPanel(result, ggx) +
         HemispherePanel(result) + "unset multiplot\n";
}

std::string DrawCavities(const CavityResult& result, const std::string& title, bool ggx,
                         const std::string& name) {
  std::string quoted;
  for (const char c : name) quoted += c == '\'' ? "''" : std::string(1, c);
  const std::string script =
      fmt::format("set encoding utf8\nset terminal {}\nset output '{}'\n", PictureTerminal(name), quoted) +
      CavityScript(result, title, ggx) + "set output\n";
  std::FILE* const pipe = popen("gnuplot -", "w");
  if (pipe == nullptr) return "cannot run gnuplot";
  const bool sent = std::fwrite(script.data(), 1, script.size(), pipe) == script.size();
  return pclose(pipe) == 0 && sent ? "" : fmt::format("gnuplot could not draw '{}'", name);
}

}  // namespace microlane
