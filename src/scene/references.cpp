#include "scene/references.h"

#include "scene/suggestions.h"

namespace turbid {
namespace {

std::string place(const SourceLocation& where) {
  return where.file + ":" + std::to_string(where.line) + ":" + std::to_string(where.column);
}

constexpr size_t kLongestChain = 500;

}  // namespace

void References::check_free(const std::string& id, const SourceLocation& where) const {
  const auto node = nodes_.find(id);
  const auto other = aliases_.find(id);
  if (node == nodes_.end() && other == aliases_.end()) return;
  const SourceLocation& first = node != nodes_.end() ? node->second->where : other->second.where;
  throw SceneError(where, "the id '" + id + "' is already used at " + place(first));
}

void References::declare(const std::shared_ptr<const SceneNode>& node) {
  check_free(node->id, node->where);
  nodes_[node->id] = node;
}

void References::alias(const std::string& id, const std::string& as, const SourceLocation& where) {
  check_free(as, where);
  aliases_[as] = {id, where};
}

void References::refer(SceneNode& owner, size_t child, const std::string& id) {
  pending_[&owner].push_back({&owner, child, id});
}

std::shared_ptr<const SceneNode> References::find(const std::string& id, const SourceLocation& where) const {
  std::string name = id;
  for (size_t hops = 0; aliases_.contains(name); ++hops) {
    if (hops > aliases_.size()) throw SceneError(where, "the alias '" + id + "' refers to itself");
    name = aliases_.at(name).id;
  }
  if (const auto found = nodes_.find(name); found != nodes_.end()) return found->second;
  std::vector<std::string> ids;
  for (const auto& [known, node] : nodes_) ids.push_back(known);
  for (const auto& [known, target] : aliases_) ids.push_back(known);
  throw SceneError(where, "there is nothing with the id '" + name + "'" + suggestion(name, ids));
}

void References::refuse_cycle(const SceneNode& node) const {
  std::string chain;
  for (const Pending* reference : chain_) chain += (chain.empty() ? "'" : " -> '") + reference->id + "'";
  const Pending& last = *chain_.back();
  throw SceneError(last.owner->children[last.child].where,
                   "cyclic reference: " + chain + " leads back to " + node.describe() + " around it");
}

void References::visit(const SceneNode& node) {
  const auto state = states_.find(&node);
  if (state != states_.end() && state->second == State::kOpen) refuse_cycle(node);
  if (state != states_.end()) return;
  states_[&node] = State::kOpen;
  for (const Child& child : node.children)
    if (child.node) visit(*child.node);
  if (const auto pending = pending_.find(&node); pending != pending_.end()) {
    for (const Pending& reference : pending->second) {
      Child& child = reference.owner->children[reference.child];
      const std::shared_ptr<const SceneNode> target = find(reference.id, child.where);
      if (chain_.size() >= kLongestChain) throw SceneError(child.where, "references are nested too deeply");
      chain_.push_back(&reference);
      visit(*target);
      chain_.pop_back();
      child.node = target;
    }
  }
  states_[&node] = State::kDone;
}

void References::link(const std::shared_ptr<const SceneNode>& root) {
  visit(*root);
  for (const auto& [as, target] : aliases_) find(as, target.where);
}

}  // namespace turbid
