#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/parallel.h"
#include "plant/attach_branches.h"
#include "plant/axis_fit.h"
#include "plant/axis_tree.h"
#include "plant/load.h"
#include "plant/skin_branches.h"
#include "plant/surface_branches.h"

namespace verdure {
namespace {

/// A piece of wood shorter than this many of its radii is a burr and hangs on the nearest branch.
constexpr float kBurr = 2.0f;
/// Of the thickest end: thinner ends are tips, wherever they are.
constexpr float kThinEnd = 0.5f;

/// The farthest point from `sources` along the patch.
std::uint32_t farthestFrom(const WoodPatch& patch, const PatchGraph& graph,
                           std::span<const std::uint32_t> sources) {
  const std::vector<float> distance = surfaceDistance(patch, graph, sources);
  return static_cast<std::uint32_t>(std::max_element(distance.begin(), distance.end()) -
                                    distance.begin());
}

/// The branches of a patch from one end of its longest way; which of its ends is the root is not
/// known yet.
PatchBranches branchesFromAnEnd(const WoodPatch& patch, const PatchGraph& graph) {
  std::uint32_t end = 0;
  for (std::uint32_t p = 1; p < patch.points.size(); ++p)
    if (patch.points[p].y < patch.points[end].y) end = p;
  for (int i = 0; i < 2; ++i) end = farthestFrom(patch, graph, graph.rimThrough(end));
  return branchesOfPatch(patch, graph, graph.rimThrough(end));
}

struct Piece {
  std::uint32_t patch = 0;
  PatchBranches found;

  bool isBurr() const {
    float thickest = 0.0f;
    for (const BranchPoint& p : found.branches[0].points) thickest = std::max(thickest, p.radius);
    return found.branches.size() == 1 && axisLength(found.branches[0].points) <= kBurr * thickest;
  }
};

/// Branches of many pieces with the piece of each.
struct Branches {
  std::vector<Branch> list;
  std::vector<std::uint32_t> piece;

  /// Appends a piece's branches, whose parents count from its first one.
  void add(const std::vector<Branch>& branches, std::uint32_t number) {
    const auto first = static_cast<std::uint32_t>(list.size());
    for (const Branch& branch : branches) {
      list.push_back(branch);
      if (branch.parent != kNone) list.back().parent += first;
      piece.push_back(number);
    }
  }
};

/// The end of a piece at which it is held: what is thick, touches what is at least about as thick,
/// or stands low. Tip of branch `end`, or kNone for where the search began.
std::uint32_t chooseRoot(const Piece& piece, std::uint32_t number, const Branches& all,
                         const AxisTree& axes, float ground, float height) {
  struct End {
    std::uint32_t tip = kNone;
    glm::vec3 position{0.0f};
    float radius = 0.0f;
  };
  std::vector<End> ends;
  float thickest = 0.0f;
  for (std::uint32_t b = 0; b < piece.found.branches.size(); ++b) {
    const std::vector<BranchPoint>& axis = piece.found.branches[b].points;
    const float length = axisLength(axis);
    if (b == 0) ends.push_back({kNone, axis.front().position, radiusOnAxis(axis, 0.1f * length)});
    ends.push_back({b, axis.back().position, radiusOnAxis(axis, 0.9f * length)});
  }
  for (const End& end : ends) thickest = std::max(thickest, end.radius);
  std::uint32_t best = kNone;
  float most = -1.0f;
  for (const End& end : ends) {
    float score = thickest > 0.0f ? end.radius / thickest : 1.0f;
    if (score < kThinEnd) continue;
    for (const AxisHit& hit : axes.within(end.position, 0.5f * end.radius))
      if (all.piece[hit.branch] != number && hit.radius >= 0.7f * end.radius) {
        score += 0.5f;
        break;
      }
    float low = std::numeric_limits<float>::max();
    for (const End& other : ends) low = std::min(low, other.position.y);
    if (end.position.y <= low && end.position.y <= ground + 0.1f * height) score += 0.25f;
    if (score > most + 1e-3f) {
      most = score;
      best = end.tip;
    }
  }
  return best;
}

void turnPieces(const WoodSurface& wood, std::vector<Piece>& pieces) {
  Branches all;
  float low = std::numeric_limits<float>::max(), high = std::numeric_limits<float>::lowest();
  for (std::uint32_t i = 0; i < pieces.size(); ++i) {
    all.add(pieces[i].found.branches, i);
    for (const glm::vec3& p : wood.patches[pieces[i].patch].points) {
      low = std::min(low, p.y);
      high = std::max(high, p.y);
    }
  }
  const AxisTree axes(all.list);
  parallelFor(pieces.size(), 1, [&](std::size_t i) {
    Piece& piece = pieces[i];
    const std::uint32_t tip =
        chooseRoot(piece, static_cast<std::uint32_t>(i), all, axes, low, high - low);
    if (tip == kNone) return;
    const WoodPatch& patch = wood.patches[piece.patch];
    const PatchGraph graph(patch);
    piece.found = branchesOfPatch(patch, graph, graph.rimThrough(piece.found.tips[tip]));
  });
}

/// Levels and places on parents; parents before children. Returns the new number of each branch.
std::vector<std::uint32_t> putInOrder(std::vector<Branch>& branches) {
  const std::size_t count = branches.size();
  std::vector<std::vector<std::uint32_t>> children(count);
  std::vector<std::uint32_t> order;
  for (std::uint32_t b = 0; b < count; ++b)
    (branches[b].parent == kNone ? order : children[branches[b].parent]).push_back(b);
  for (std::size_t i = 0; i < order.size(); ++i) {
    Branch& branch = branches[order[i]];
    branch.level = 0;
    if (branch.parent != kNone) {
      const std::vector<BranchPoint>& axis = branches[branch.parent].points;
      branch.level = branches[branch.parent].level + 1;
      const float length = axisLength(axis);
      const float along = placeOnAxis(axis, branch.points.front().position).first;
      branch.parent_offset = length > 0.0f ? glm::clamp(along / length, 0.0f, 1.0f) : 0.0f;
    }
    order.insert(order.end(), children[order[i]].begin(), children[order[i]].end());
  }
  std::vector<std::uint32_t> number(count);
  for (std::uint32_t i = 0; i < count; ++i) number[order[i]] = i;
  std::vector<Branch> sorted(count);
  for (std::uint32_t b = 0; b < count; ++b) {
    if (branches[b].parent != kNone) branches[b].parent = number[branches[b].parent];
    sorted[number[b]] = std::move(branches[b]);
  }
  branches = std::move(sorted);
  return number;
}

/// Foliage without wood sways as a whole.
void standUpright(Plant& plant) {
  const Bounds box = bounds(plant);
  if (vertexCount(plant) == 0) return;
  const float height = std::max(box.size().y, 1e-3f);
  const glm::vec3 foot(box.center().x, box.min.y, box.center().z);
  Branch branch;
  branch.points = {{foot, 0.01f * height}, {foot + glm::vec3(0, height, 0), 0.005f * height}};
  plant.branches.push_back(branch);
  plant.notes.push_back("branches: no wood to find them in, the plant is one upright branch");
}

void noteBranches(Plant& plant, std::size_t of_skin) {
  int levels = 0;
  for (const Branch& branch : plant.branches) levels = std::max(levels, branch.level + 1);
  plant.notes.push_back(
      fmt::format("branches: {} in {} levels, {}", withCommas(plant.branches.size()), levels,
                  of_skin == 0                       ? "found in the bark"
                  : of_skin == plant.branches.size() ? "as the file's skin has them"
                                                     : "of the file's skin and found in the bark"));
}

}  // namespace

void findBranches(Plant& plant) {
  plant.branches.clear();
  for (Mesh& mesh : plant.meshes) mesh.branch_of_vertex.clear();
  for (Leaf& leaf : plant.leaves) leaf.branch = kNone;
  std::erase_if(plant.notes, [](const std::string& n) { return n.starts_with("branches: "); });

  const SkinBranches skin = branchesOfSkins(plant);
  std::vector<bool> skinned(plant.meshes.size());
  for (std::size_t m = 0; m < skinned.size(); ++m) skinned[m] = !skin.branch_of_vertex[m].empty();

  const WoodSurface wood = weldWood(plant, skinned);
  std::vector<Piece> pieces(wood.patches.size());
  parallelFor(pieces.size(), 1, [&](std::size_t i) {
    pieces[i].patch = static_cast<std::uint32_t>(i);
    const PatchGraph graph(wood.patches[i]);
    pieces[i].found = branchesFromAnEnd(wood.patches[i], graph);
  });
  // Burrs are no branches, unless there is nothing else.
  if (!skin.branches.empty() ||
      !std::all_of(pieces.begin(), pieces.end(), [](const Piece& p) { return p.isBurr(); }))
    std::erase_if(pieces, [](const Piece& p) { return p.isBurr(); });
  turnPieces(wood, pieces);

  Branches all;
  all.add(skin.branches, 0);
  std::vector<bool> fixed{true};
  std::vector<std::uint32_t> first_of_patch(wood.patches.size(), kNone);
  for (const Piece& piece : pieces) {
    first_of_patch[piece.patch] = static_cast<std::uint32_t>(all.list.size());
    all.add(piece.found.branches, static_cast<std::uint32_t>(fixed.size()));
    fixed.push_back(false);
  }
  attachPieces(all.list, all.piece, fixed);
  const std::vector<std::uint32_t> number = putInOrder(all.list);
  plant.branches = std::move(all.list);
  if (plant.branches.empty())
    standUpright(plant);
  else
    noteBranches(plant, skin.branches.size());

  const AxisTree axes(plant.branches);
  std::vector<const PatchBranches*> of_patch(wood.patches.size(), nullptr);
  for (const Piece& piece : pieces) of_patch[piece.patch] = &piece.found;
  for (std::size_t m = 0; m < plant.meshes.size(); ++m) {
    Mesh& mesh = plant.meshes[m];
    if (mesh.kind != PartKind::kWood) continue;
    mesh.branch_of_vertex.resize(mesh.positions.size());
    parallelFor(mesh.positions.size(), 1024, [&](std::size_t v) {
      std::uint32_t branch = kNone;
      if (skinned[m]) {
        branch = skin.branch_of_vertex[m][v];
        if (branch != kNone) branch = number[branch];
      } else if (const WoodVertex at = wood.vertices[m][v];
                 at.patch != kNone && of_patch[at.patch] != nullptr) {
        branch = number[first_of_patch[at.patch] + of_patch[at.patch]->branch_of_point[at.point]];
      }
      mesh.branch_of_vertex[v] = branch != kNone ? branch : axes.nearest(mesh.positions[v]).branch;
    });
  }
  parallelFor(plant.leaves.size(), 256, [&](std::size_t l) {
    Leaf& leaf = plant.leaves[l];
    if (skinned[leaf.mesh] && leaf.triangle_count > 0) {
      const std::size_t triangle = plant.leaf_triangles[leaf.first_triangle];
      const std::uint32_t b =
          skin.branch_of_vertex[leaf.mesh][plant.meshes[leaf.mesh].indices[3 * triangle]];
      if (b != kNone) leaf.branch = number[b];
    }
    if (leaf.branch == kNone) leaf.branch = axes.nearest(leaf.stalk).branch;
  });
}

}  // namespace verdure
