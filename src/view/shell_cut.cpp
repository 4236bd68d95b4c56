#include "view/shell_cut.h"

#include <algorithm>
#include <cmath>

#include "view/colour.h"

namespace evenmesh {
namespace {

constexpr std::uint32_t paper = 0xffffff, nearest = 0x2b5fa8, farthest = 0xd3e2f5, line = 0xd8352a;

struct Point {
  double u = 0, v = 0;  ///< voxels, to the right and up
};

class Cut {
 public:
  Cut(const SparseVolume& volume, int width, double window) : volume_(volume) {
    while (axis_ < 2 && std::any_of(volume.voxels.begin(), volume.voxels.end(),
                                    [&](const auto& v) { return v[axis_] != volume.voxels[0][axis_]; }))
      ++axis_;
    right_ = axis_ == 0 ? 1 : 0;
    up_ = axis_ == 2 ? 1 : 2;
    lo_ = {1e9, 1e9};
    Point hi{-1e9, -1e9};
    for (const auto& v : volume.voxels) {
      lo_ = {std::min(lo_.u, v[right_] - 2.5), std::min(lo_.v, v[up_] - 2.5)};
      hi = {std::max(hi.u, v[right_] + 2.5), std::max(hi.v, v[up_] + 2.5)};
    }
    if (window > 0) {
      const auto& middle = volume.voxels[volume.voxels.size() / 2];
      lo_ = {middle[right_] - window / 2, middle[up_] - window / 2};
      hi = {lo_.u + window, lo_.v + window};
    }
    scale_ = width / (hi.u - lo_.u);
    image_.width = width;
    image_.height = std::clamp(static_cast<int>(std::lround((hi.v - lo_.v) * scale_)), 16, 4 * width);
    image_.rgb.resize(std::size_t(3) * std::size_t(image_.width) * std::size_t(image_.height));
    for (int y = 0; y < image_.height; ++y)
      for (int x = 0; x < image_.width; ++x) set(x, y, paper);
  }

  void draw_voxels() {
    const float most = *std::max_element(volume_.values.begin(), volume_.values.end());
    for (std::size_t i = 0; i < volume_.voxels.size(); ++i) {
      const auto& voxel = volume_.voxels[i];
      const double t = most > 0 ? volume_.values[i] / most : 0;
      const Colour colour = mix(from_srgb(nearest), from_srgb(farthest), t);
      const std::uint32_t rgb = static_cast<std::uint32_t>(to_srgb_byte(colour.x)) << 16 |
                                static_cast<std::uint32_t>(to_srgb_byte(colour.y)) << 8 | to_srgb_byte(colour.z);
      const double gap = scale_ >= 6 ? 1 : 0;  // a grid, where there is room for one
      const int x0 = column(voxel[right_] - 0.5), x1 = std::max(x0 + 1, column(voxel[right_] + 0.5) - int(gap));
      const int y1 = row(voxel[up_] - 0.5), y0 = std::min(y1 - 1, row(voxel[up_] + 0.5) + int(gap));
      for (int y = std::max(0, y0); y < std::min(y1, image_.height); ++y)
        for (int x = std::max(0, x0); x < std::min(x1, image_.width); ++x) set(x, y, rgb);
    }
  }

  void draw_section(const Mesh& mesh) {
    const double plane = volume_.origin[int(axis_)] + volume_.side * volume_.voxels[0][axis_];
    for (const Triangle& t : mesh.triangles) {
      Point ends[2];
      int count = 0;
      for (std::size_t c = 0; c < 3 && count < 2; ++c) {
        const Vec3 &a = mesh.vertices[t[c]], &b = mesh.vertices[t[(c + 1) % 3]];
        const double da = a[int(axis_)] - plane, db = b[int(axis_)] - plane;
        if ((da < 0) == (db < 0)) continue;
        const Vec3 p = a + da / (da - db) * (b - a);
        ends[count++] = {(p[int(right_)] - volume_.origin[int(right_)]) / volume_.side,
                         (p[int(up_)] - volume_.origin[int(up_)]) / volume_.side};
      }
      if (count == 2) draw_line(ends[0], ends[1]);
    }
  }

  Image result() { return std::move(image_); }

 private:
  int column(double u) const { return static_cast<int>(std::floor((u - lo_.u) * scale_)); }
  int row(double v) const { return image_.height - static_cast<int>(std::floor((v - lo_.v) * scale_)); }
  void set(int x, int y, std::uint32_t rgb) {
    std::uint8_t* pixel = &image_.rgb[3 * (std::size_t(y) * std::size_t(image_.width) + std::size_t(x))];
    pixel[0] = rgb >> 16 & 255;
    pixel[1] = rgb >> 8 & 255;
    pixel[2] = rgb & 255;
  }
  void draw_line(const Point& a, const Point& b) {
    const double length = std::hypot(b.u - a.u, b.v - a.v) * scale_;
    const int steps = static_cast<int>(std::min(1e5, 2 * length)) + 1;
    for (int s = 0; s <= steps; ++s) {
      const double t = static_cast<double>(s) / steps;
      const int x = column(a.u + t * (b.u - a.u)), y = row(a.v + t * (b.v - a.v));
      for (int j = y - 1; j <= y; ++j)
        for (int i = x; i <= x + 1; ++i)
          if (i >= 0 && i < image_.width && j >= 0 && j < image_.height) set(i, j, line);
    }
  }

  const SparseVolume& volume_;
  std::size_t axis_ = 0, right_ = 0, up_ = 0;
  Point lo_;
  double scale_ = 1;  ///< pixels per voxel
  Image image_;
};

}  // namespace

Image shell_cut_image(const SparseVolume& volume, const Mesh& mesh, int width, double window) {
  Cut cut(volume, width, window);
  cut.draw_voxels();
  cut.draw_section(mesh);
  return cut.result();
}

}  // namespace evenmesh
