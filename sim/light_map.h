#pragma once

#include <Eigen/Core>
#include <map>
#include <vector>

#include "sim/polygon_cut.h"
#include "sim/world.h"

namespace plumbline {

/// The illuminance [lux] by lamps of some surfaces, in one picture of bilinearly filtered texels: what stands still
/// under lamps that stand still need not be lit anew, lamp by lamp, for every pixel of every frame.
struct LightMap {
  int width = 0;
  int height = 0;
  std::vector<float> lux;
};

/// Collects flat pieces of surface, gives each a rectangle of the picture, and then lights all of them. The texels are
/// so fine, down to 1/16 m, that filtering between them errs by some 0.5 % where a lamp is 0.8 m away or more.
class LightMapBuilder {
 public:
  /// The lamps must outlive the builder.
  explicit LightMapBuilder(const std::vector<Lamp>& lamps);

  /// Where each corner of a piece lies on the picture, in texels; texel (i, j) has its centre at (i + 0.5, j + 0.5).
  /// @param normal  unit, towards the lit side
  /// @param lamps   indices of those that reach the piece
  std::vector<Eigen::Vector2f> add(const Polygon& piece, const Eigen::Vector3d& normal, const std::vector<int>& lamps);

  /// Whether any lamp shines on any piece.
  bool lit() const { return patches_.size() > 1; }
  LightMap light() const;

 private:
  struct Patch {
    Eigen::Vector3d corner;  ///< world position of texel (0, 0)'s centre
    Eigen::Vector3d right;   ///< to the next texel of the row [m]
    Eigen::Vector3d down;    ///< to the next row
    Eigen::Vector3d normal;
    Eigen::Vector2i size;   ///< [texels]
    Eigen::Vector2i place;  ///< of texel (0, 0)
    std::vector<int> lamps;
  };
  struct Shelf {
    int x = 0;
    int y = 0;
  };

  std::vector<int> lamps_in_front(const Polygon& piece, const Eigen::Vector3d& normal,
                                  const std::vector<int>& lamps) const;
  double texel_size(const Polygon& piece, const std::vector<int>& lamps) const;
  Eigen::Vector2i reserve(const Eigen::Vector2i& size);
  double illuminance(const Patch& patch, const Eigen::Vector3d& point) const;

  const std::vector<Lamp>& lamps_;
  std::vector<Patch> patches_;
  std::map<int, Shelf> shelf_of_height_;
  int height_ = 0;
};

}  // namespace plumbline
