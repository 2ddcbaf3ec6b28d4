// What panels on show ask for.
#include "app/window/asked_work.h"

#include "app/window/background_work.h"
#include "tracer/choice.h"

namespace app {
namespace {

// What the rays of a snapshot's picture are traced with.
struct Traced {
  explicit Traced(const tracer::Snapshot& snapshot)
      : world{*snapshot.scene, *snapshot.bvh, *snapshot.settings.look, snapshot.settings.render},
        camera(tracer::frame(world.look.camera, world.options.width, world.options.height)) {}

  tracer::World world;
  tracer::CameraFrame camera;
};

tracer::CountedVisits counted_visits(const tracer::Snapshot& snapshot, const tracer::Job& job) {
  const Traced traced(snapshot);
  return {snapshot.bvh, tracer::count_visits(traced.world, traced.camera, job)};
}

ui::LoggedRays logged(const ui::RayRequest& request, const tracer::Snapshot& snapshot) {
  const Traced traced(snapshot);
  tracer::RayLog log =
      request.again ? tracer::log_again(*request.again, snapshot.bvh)
                    : tracer::log_pixel(traced.world, snapshot.bvh, traced.camera, request.pixel);
  return {request, std::make_shared<const tracer::RayLog>(std::move(log))};
}

ui::WatchedPixels pixels_of(const tracer::Watched& node, const tracer::Snapshot& snapshot,
                            const tracer::Job& job) {
  const Traced traced(snapshot);
  return {snapshot.render_generation,
          tracer::node_pixels(traced.world, snapshot.bvh, traced.camera, node, job)};
}

// The shape that the trees were built over.
std::shared_ptr<const tracer::Scene> built_scene(const tracer::Snapshot& snapshot) {
  if (!snapshot.update.refitted) return snapshot.scene;
  if (snapshot.update.built_time < 0.0f) return snapshot.rest;
  return tracer::deformed(snapshot.rest, snapshot.settings.deformer, snapshot.update.built_time);
}

tracer::Replay replay_of(uint32_t mesh, const tracer::Snapshot& snapshot, const tracer::Job& job) {
  if (mesh == tracer::none) return tracer::replay_build(snapshot.bvh, mesh, nullptr, job);
  const std::shared_ptr<const tracer::Scene> scene = built_scene(snapshot);
  return tracer::replay_build(snapshot.bvh, mesh, &scene->meshes[mesh], job);
}

std::shared_ptr<const tracer::TreeTable> shared_table(const tracer::Inspection& inspection,
                                                      uint32_t mesh) {
  if (mesh == tracer::none) return inspection.tlas;
  return mesh < inspection.blases.size() ? inspection.blases[mesh] : nullptr;
}

// The table of one of the snapshot's trees, once it is there.
std::shared_ptr<const tracer::TreeTable> present_table(
    const ui::Background<tracer::Inspection>& inspection, uint32_t mesh,
    const tracer::Snapshot& snapshot) {
  if (!inspection.result || inspection.result->bvh != snapshot.bvh) return nullptr;
  return shared_table(*inspection.result, mesh);
}

void keep_hot_spots(BackgroundWork& work, int ray_class, const tracer::Snapshot& snapshot) {
  const HotWanted wanted{work.inspection.state().result, work.visits.state().result, ray_class};
  if (!wanted.inspection || !wanted.counted || wanted.inspection->bvh != snapshot.bvh ||
      wanted.counted->bvh != snapshot.bvh) {
    return;
  }
  work.hot_spots.keep(wanted, [wanted, scene = snapshot.scene](const tracer::Job& job) {
    return tracer::hot_spots(*scene, wanted.inspection, wanted.counted, wanted.ray_class,
                             most_hot_spots, job);
  });
}

// Of the newest tables; again when what its widths or colours are made of is there.
void keep_icicle(BackgroundWork& work, const tracer::IcicleOptions& options) {
  const tracer::IcicleSources sources =
      tracer::icicle_sources(options, work.inspection.state().result, work.visits.state().result,
                             work.measures.state().result);
  if (!sources.inspection) return;
  work.icicle.keep(sources,
                   [sources](const tracer::Job& job) { return tracer::make_icicle(sources, job); });
}

void keep_splits(BackgroundWork& work, const ui::NodePlace& place,
                 const tracer::Snapshot& snapshot) {
  const auto table = present_table(work.inspection.state(), place.mesh, snapshot);
  if (!table || place.node >= table->nodes.size()) return;
  work.splits.keep({place, snapshot.bvh}, [place, table, scene = snapshot.scene,
                                           bvh = snapshot.bvh](const tracer::Job& job) {
    return tracer::node_splits(*scene, bvh, *table, place.mesh, place.node, job);
  });
}

// nullptr: there is none.
std::shared_ptr<const void> tree_of(const tracer::Snapshot& snapshot, uint32_t mesh) {
  if (!snapshot.bvh || mesh == tracer::none) return snapshot.bvh;
  const auto& blases = snapshot.bvh->blases;
  return mesh < blases.size() ? blases[mesh] : nullptr;
}

void keep_replay(BackgroundWork& work, uint32_t mesh, const tracer::Snapshot& snapshot) {
  const std::shared_ptr<const void> tree = tree_of(snapshot, mesh);
  if (!tree) return;
  work.replay.keep({tree, mesh}, [mesh, snapshot](const tracer::Job& job) {
    return replay_of(mesh, snapshot, job);
  });
}

// Their results would keep trees that are gone.
void forget_trees(BackgroundWork& work) {
  work.inspection.forget();
  work.visits.forget();
  work.hot_spots.forget();
  work.icicle.forget();
  work.node_pixels.forget();
  work.splits.forget();
}

}  // namespace

void keep_inspected(BackgroundWork& work, const ui::Requests& requests,
                    const tracer::Snapshot& snapshot) {
  const bool asked = requests.inspect || requests.count_visits;
  if (!asked && work.inspection.wanted() && *work.inspection.wanted() != snapshot.bvh) {
    forget_trees(work);
  }
  const auto& replayed = work.replay.wanted();
  if (!requests.replay && replayed && replayed->tree != tree_of(snapshot, replayed->mesh)) {
    work.replay.forget();
  }
  const bool pictured = snapshot.samples > 0 && snapshot.stage >= tracer::Stage::refine;
  if (!snapshot.bvh || !pictured) return;
  if (requests.inspect) {
    work.inspection.keep(
        snapshot.bvh,
        [bvh = snapshot.bvh, before = work.inspection.state().result](const tracer::Job& job) {
          return tracer::inspect(bvh, before.get(), job);
        });
  }
  if (requests.count_visits) {
    work.visits.keep(snapshot.render_generation,
                     [snapshot](const tracer::Job& job) { return counted_visits(snapshot, job); });
  }
  if (requests.hot_spots) keep_hot_spots(work, *requests.hot_spots, snapshot);
  if (requests.icicle) keep_icicle(work, *requests.icicle);
  if (requests.node_pixels) {
    work.node_pixels.keep({*requests.node_pixels, snapshot.render_generation},
                          [node = *requests.node_pixels, snapshot](const tracer::Job& job) {
                            return pixels_of(node, snapshot, job);
                          });
  }
  if (requests.node_splits) keep_splits(work, *requests.node_splits, snapshot);
  if (requests.replay) keep_replay(work, *requests.replay, snapshot);
}

void keep_logged(BackgroundWork& work, const ui::Requests& requests,
                 const tracer::Snapshot& snapshot) {
  if (!requests.log_rays) {
    // It would keep a tree that is gone.
    if (work.rays.wanted() && work.rays.wanted()->bvh != snapshot.bvh) work.rays.forget();
    return;
  }
  const tracer::RenderOptions& picture = snapshot.settings.render;
  const tracer::ivec2 pixel = requests.log_rays->pixel;
  const bool inside =
      requests.log_rays->again ||
      (pixel.x >= 0 && pixel.y >= 0 && pixel.x < picture.width && pixel.y < picture.height);
  if (!snapshot.bvh || !snapshot.settings.look || !inside) return;
  work.rays.keep({*requests.log_rays, snapshot.render_generation, snapshot.bvh},
                 [request = *requests.log_rays, snapshot](const tracer::Job&) {
                   return logged(request, snapshot);
                 });
}

void answer(ui::Work& work, const ui::Requests& requests, const tracer::Snapshot& snapshot) {
  const auto give = [](auto& background, auto result) {
    background.result = std::make_shared<const decltype(result)>(std::move(result));
  };
  if (!snapshot.bvh) return;
  if (requests.inspect) {
    give(work.inspection, tracer::inspect(snapshot.bvh, work.inspection.result.get(), {}));
  }
  if (requests.count_visits) give(work.visits, counted_visits(snapshot, {}));
  if (requests.hot_spots) {
    give(work.hot_spots,
         tracer::hot_spots(*snapshot.scene, work.inspection.result, work.visits.result,
                           *requests.hot_spots, most_hot_spots, {}));
  }
  if (requests.icicle) {
    give(work.icicle,
         tracer::make_icicle(tracer::icicle_sources(*requests.icicle, work.inspection.result,
                                                    work.visits.result, work.measures.result),
                             {}));
  }
  if (requests.node_pixels) give(work.node_pixels, pixels_of(*requests.node_pixels, snapshot, {}));
  if (requests.node_splits) {
    const ui::NodePlace place = *requests.node_splits;
    const auto table = present_table(work.inspection, place.mesh, snapshot);
    if (table && place.node < table->nodes.size()) {
      give(work.splits,
           tracer::node_splits(*snapshot.scene, snapshot.bvh, *table, place.mesh, place.node, {}));
    }
  }
  if (requests.log_rays) give(work.rays, logged(*requests.log_rays, snapshot));
  if (requests.replay) give(work.replay, replay_of(*requests.replay, snapshot, {}));
}

}  // namespace app
