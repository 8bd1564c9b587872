#include "scene/medium_stack.h"

#include <algorithm>

#include "scene/scene.h"

namespace turbid {
namespace {

/// Objects stand in one array in the order of the file.
bool outranks(const Object& a, const Object& b) {
  return a.priority != b.priority ? a.priority > b.priority : std::less<const Object*>()(&b, &a);
}

}  // namespace

MediumStack& MediumStack::operator=(const MediumStack& other) {
  std::copy_n(other.entries_.begin(), other.size_, entries_.begin());
  size_ = other.size_;
  outside_ = other.outside_;
  return *this;
}

const Medium* MediumStack::medium() const { return size_ > 0 ? entries_[0].object->interior.get() : outside_; }

bool MediumStack::hides(const Object& object) const {
  return size_ > 0 && object.encloses && !object.emitter && outranks(*entries_[0].object, object);
}

void MediumStack::cross(const Object& object, const Vec3& ng, const Vec3& from, const Vec3& towards) {
  const bool outwards = leads_outside(ng, towards);
  if (outwards == leads_outside(ng, from)) return;
  if (outwards && object.exterior) outside_ = object.exterior.get();
  if (!object.encloses) return;
  if (outwards)
    leave(object);
  else
    enter(object);
}

void MediumStack::enter(const Object& object) {
  size_t at = 0;
  while (at < size_ && outranks(*entries_[at].object, object)) ++at;
  if (at < size_ && entries_[at].object == &object) {
    ++entries_[at].count;
    return;
  }
  if (at == kMost) return;
  size_ = std::min(size_ + 1, kMost);
  std::move_backward(entries_.begin() + static_cast<std::ptrdiff_t>(at),
                     entries_.begin() + static_cast<std::ptrdiff_t>(size_ - 1),
                     entries_.begin() + static_cast<std::ptrdiff_t>(size_));
  entries_[at] = {&object, 1};
}

void MediumStack::leave(const Object& object) {
  const auto end = entries_.begin() + static_cast<std::ptrdiff_t>(size_);
  const auto entry = std::find_if(entries_.begin(), end, [&](const Entry& e) { return e.object == &object; });
  if (entry == end || --entry->count > 0) return;
  std::move(entry + 1, end, entry);
  --size_;
}

}  // namespace turbid
