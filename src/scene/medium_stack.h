#pragma once
#include <array>
#include <cstddef>

#include "core/vector.h"

namespace turbid {

struct Object;
class Medium;

/// The shapes with media that a walk is inside of, and which of their media counts. A value, carried by walks and
/// shadow rays in scenes that declare a `priority` or a `world` medium (Scene::has_priorities); other scenes keep
/// Mitsuba's rule, that the surface that is crossed decides, and need none.
///
/// The rule. A shape encloses space when it has an interior medium or a priority of its own, and in scenes with a world
/// medium also when it is closed and its bsdf transmits (glass without a medium is empty inside). At each point the
/// enclosing shape of the highest priority counts; among equals that which stands later in the file. Its interior (or
/// vacuum) is the medium there. Where nothing encloses, it is the exterior medium of the surface left last that
/// declares one, else the world medium, else vacuum. Boundaries of a shape inside another that counts more are not
/// there at all: light passes them as if they were null (shapes that shine are always there). Indices of refraction
/// stay as the bsdf says.
///
/// Open boundaries: whoever enters through one is inside until a surface of the same shape is left, or to the end of
/// the world; leaving a shape that one is not inside changes nothing.
class MediumStack {
 public:
  explicit MediumStack(const Medium* outside = nullptr) : outside_(outside) {}
  MediumStack(const MediumStack& other) { *this = other; }
  MediumStack& operator=(const MediumStack& other);

  /// What fills the space here; null: vacuum.
  const Medium* medium() const;
  /// The object's surface does not exist here: something of higher rank encloses the place.
  bool hides(const Object& object) const;
  /// Goes from one side of the object's surface to the other, or stays on the same one: `from` and `towards` point away
  /// from the surface, ng to its outside.
  void cross(const Object& object, const Vec3& ng, const Vec3& from, const Vec3& towards);
  void enter(const Object& object);
  void leave(const Object& object);

 private:
  /// Entered `count` times more than left.
  struct Entry {
    const Object* object;
    int count;
  };
  /// Where more shapes than this enclose a point, those of the lowest rank are forgotten.
  static constexpr size_t kMost = 16;

  std::array<Entry, kMost> entries_;  ///< the first size_ are in use, highest rank first; all of different objects
  size_t size_ = 0;
  const Medium* outside_;
};

}  // namespace turbid
