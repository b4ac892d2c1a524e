#include "server/cache/scene_store.h"

#include <gtest/gtest.h>

#include "core/accelerators/registry.h"
#include "core/base/error.h"
#include "server/base/errors.h"
#include "server/http/message.h"

// Tests loading and eviction of scenes.
namespace orrery {
namespace {

std::string text_of(const std::string& title, const std::string& objects) {
  return R"({"version": 1, "title": ")" + title +
         R"(", "camera": {"type": "perspective", "eye": [0, 1, 4], "look_at": [0, 0, 0]},)"
         R"( "materials": {"m": {"type": "rough"}}, "objects": [)" +
         objects + "]}";
}

Document ball(const std::string& title) {
  return parse_document(
      text_of(title, R"({"type": "sphere", "center": [0, 0, 0], "radius": 1, "material": "m"})"));
}

// Returns a scene with `count` copies of one object, so that its size grows with `count`.
Document balls(const std::string& title, int count) {
  std::string objects;
  for (int i = 0; i < count; ++i)
    objects += std::string(i > 0 ? "," : "") +
               R"({"type": "sphere", "center": [0, 0, 0], "radius": 1, "material": "m"})";
  return parse_document(text_of(title, objects));
}

// Asset source that returns one triangle and counts the reads.
class CountedMeshes final : public AssetSource {
 public:
  MeshModelPtr model_asset(const std::string&, const ModelState&) const override {
    ++reads;
    return model_of(
        {.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, .triangles = {{0, 1, 2}}, .normals = {}, .uvs = {}});
  }
  mutable int reads = 0;
};

const AssetSource kNoMeshes;
const std::string kClient = "someone";

// Scene store with work memory.
struct Store {
  explicit Store(std::size_t max_bytes) : scenes(max_bytes, work) {}
  SceneStore* operator->() { return &scenes; }
  SceneStore::Prepared get(const Document& document, const AssetSource& meshes = kNoMeshes) {
    return scenes.get(document, meshes, kClient);
  }
  SceneStore::KeepResult keep(const Document& document, const AssetSource& meshes = kNoMeshes) {
    return scenes.keep(document, meshes, kClient);
  }
  bool has(const Document& document) {
    try {
      return scenes.find(document.id())->scene().id == document.id();
    } catch (const NotFound&) {
      return false;
    }
  }
  WorkMemory work{std::size_t{1} << 30};
  SceneStore scenes;
};

std::size_t size_of(const Document& document) {
  Store store(1 << 30);
  store.keep(document);
  return store->bytes();
}

TEST(SceneStore, ReusesKnownScenesWithoutReadingMeshes) {
  const std::string mesh = R"({"type": "mesh", "asset": ")" + std::string(64, 'a') + R"(", "material": "m"})";
  const CountedMeshes meshes;
  Store store(1 << 30);
  const auto rendered = store.get(parse_document(text_of("mesh", mesh)), meshes);
  EXPECT_EQ(store->loads(), 1u);
  EXPECT_EQ(store->hits(), 0u);
  EXPECT_EQ(meshes.reads, 1);
  const auto again = store.get(parse_document("\n " + text_of("mesh", " " + mesh)), meshes);
  EXPECT_EQ(again, rendered) << "the prepared scene is reused";
  const SceneStore::KeepResult kept = store.keep(parse_document(text_of("mesh", mesh)), meshes);
  EXPECT_EQ(kept.scene, rendered);
  EXPECT_FALSE(kept.known) << "the scene was cached, not kept";
  EXPECT_TRUE(store.keep(parse_document(text_of("mesh", mesh)), meshes).known);
  EXPECT_EQ(store.get(parse_document(text_of("mesh", mesh)), meshes), rendered);
  EXPECT_EQ(store->loads(), 1u);
  EXPECT_EQ(store->hits(), 4u);
  EXPECT_EQ(meshes.reads, 1);
  store.get(parse_document(text_of("other", mesh)), meshes);
  EXPECT_EQ(store->loads(), 2u);
  EXPECT_EQ(meshes.reads, 2);
}

TEST(SceneStore, NeverEvictsKeptScenesForCachedOnes) {
  Store store(3 * size_of(ball("kept")) + 100);
  store.keep(ball("kept"));
  for (const char* title : {"aaaa", "bbbb", "cccc"}) store.get(ball(title));
  EXPECT_FALSE(store.has(ball("aaaa")));
  EXPECT_TRUE(store.has(ball("bbbb")) && store.has(ball("cccc")));
  for (int i = 0; i < 10; ++i) store.get(ball(std::to_string(1000 + i)));
  EXPECT_TRUE(store.has(ball("kept"))) << "although it is the least recently used";
  EXPECT_LE(store->bytes(), 3 * size_of(ball("kept")) + 100);
}

TEST(SceneStore, CachesNothingIfKeptScenesFillStore) {
  Store store(2 * size_of(ball("kept")) - 1);
  store.keep(ball("kept"));
  EXPECT_EQ(store.get(ball("more"))->scene().title, "more");
  EXPECT_FALSE(store.has(ball("more")));
  EXPECT_TRUE(store.has(ball("kept")));
  EXPECT_EQ(store->bytes(), size_of(ball("kept")));
}

TEST(SceneStore, EvictsCachedScenesBeforeKeptOnes) {
  Store store(3 * size_of(ball("kept")) + 100);
  store.keep(ball("old1"));
  store.get(ball("cach"));
  store.keep(ball("old2"));
  store.get(ball("cach"));  // most recently used, but evicted first
  store.keep(ball("new1"));
  EXPECT_FALSE(store.has(ball("cach")));
  EXPECT_TRUE(store.has(ball("old2")) && store.has(ball("new1")) && store.has(ball("old1")));
  store.keep(ball("new2"));  // evicts the least recently used kept scene
  EXPECT_FALSE(store.has(ball("old2")));
  EXPECT_TRUE(store.has(ball("new1")) && store.has(ball("new2")) && store.has(ball("old1")));
}

TEST(SceneStore, RejectsOversizedScene) {
  const Document large = balls("large", 100);
  Store store(size_of(large) - 1);
  try {
    store.keep(large);
    ADD_FAILURE() << "kept";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("scene_cache_bytes"), std::string::npos) << error.what();
  }
  EXPECT_EQ(store.get(large)->scene().object_count, 100);
  EXPECT_EQ(store->bytes(), 0u);
}

TEST(SceneStore, RemovesCachedAndKeptScenes) {
  Store store(1 << 30);
  store.get(ball("cached"));
  store.keep(ball("kept"));
  store->remove(ball("cached").id(), kClient, false);
  store->remove(ball("kept").id(), kClient, false);
  EXPECT_THROW(store->remove(ball("kept").id(), kClient, true), NotFound);
  EXPECT_EQ(store->bytes(), 0u);
}

TEST(SceneStore, RetainsSceneUntilLastKeeperRemovesIt) {
  Store store(1 << 30);
  const Document scene = ball("kept");
  const auto remove = [&](const char* client, bool of_all) { store->remove(scene.id(), client, of_all); };
  store->keep(scene, kNoMeshes, "a");
  EXPECT_TRUE(store->keep(scene, kNoMeshes, "b").known);
  EXPECT_THROW(remove("c", false), Forbidden);
  remove("a", false);
  EXPECT_TRUE(store.has(scene));
  EXPECT_THROW(remove("a", false), Forbidden);
  remove("b", false);
  EXPECT_FALSE(store.has(scene));
  store->keep(scene, kNoMeshes, "a");
  remove("c", true);
  EXPECT_FALSE(store.has(scene));
}

TEST(SceneStore, KeepsScenesOfOtherClientsDuringFlood) {
  Store store(4 * size_of(ball("kept")) + 100);
  store->keep(ball("kept"), kNoMeshes, "a");
  store->get(ball("cach"), kNoMeshes, "b");
  for (int i = 0; i < 50; ++i) store->keep(ball(std::to_string(1000 + i)), kNoMeshes, "flood");
  for (int i = 0; i < 50; ++i) store->get(ball(std::to_string(2000 + i)), kNoMeshes, "flood");
  EXPECT_TRUE(store.has(ball("kept")) && store.has(ball("cach")));
  EXPECT_TRUE(store.has(ball("1049")) && store.has(ball("1048"))) << "its latest kept scenes remain";
  EXPECT_FALSE(store.has(ball("2049"))) << "cached scenes evict no kept ones";
}

TEST(SceneStore, RejectsSceneIfOthersFillStore) {
  const std::size_t small = size_of(ball("kept"));
  const Document large = balls("large", 100);
  Store store(size_of(large) + small / 2);
  store->keep(ball("kept"), kNoMeshes, "a");
  try {
    store->keep(large, kNoMeshes, "b");
    ADD_FAILURE() << "kept";
  } catch (const LimitExceeded& error) {
    EXPECT_STREQ(error.limit(), "scene_cache_bytes");
  }
  EXPECT_TRUE(store.has(ball("kept")));
  EXPECT_EQ(store->bytes(), small);
}

TEST(SceneStore, RejectsRemovalByOtherClients) {
  Store store(1 << 30);
  const Document scene = ball("cach");
  store->get(scene, kNoMeshes, "a");
  EXPECT_THROW(store->remove(scene.id(), "b", false), Forbidden);
  store->keep(scene, kNoMeshes, "b");
  store->remove(scene.id(), "b", false);
  EXPECT_TRUE(store.has(scene));
  store->remove(scene.id(), "a", false);
  EXPECT_FALSE(store.has(scene));
}

// Structures that another client builds for a kept scene may be evicted. The scenes of the keeping client
// must not be.
TEST(SceneStore, NeverEvictsKeptScenesForBuiltStructures) {
  const std::size_t bare = size_of(balls("kept", 2000));
  Store store(3 * bare);
  const auto scene = store->keep(balls("kept", 2000), kNoMeshes, "a").scene;
  store->keep(ball("more"), kNoMeshes, "a");
  {
    const SceneStore::SizeGuard measured(store.scenes, *scene);
    double build_ms = 0;
    store.work.open("b")->run({},
                              [&] { world_for<float>(scene->parts(), accelerator_types()[0], 0, build_ms); });
  }
  EXPECT_GT(store->bytes(), scene->loaded_bytes());
  EXPECT_EQ(store->bytes(), scene->bytes() + size_of(ball("more")));
  store->keep(balls("new1", 2000), kNoMeshes, "c");
  for (const Document& kept : {balls("kept", 2000), ball("more"), balls("new1", 2000)})
    EXPECT_TRUE(store.has(kept));
}

// Structures built for a kept scene are evicted before the scene.
TEST(SceneStore, EvictsOversizedBuiltStructures) {
  const std::size_t bare = size_of(balls("kept", 2000));
  Store store(2 * bare);
  const auto scene = store.keep(balls("kept", 2000)).scene;
  {
    const SceneStore::SizeGuard measured(store.scenes, *scene);
    double build_ms = 0;
    store.work.open("builder")->run({}, [&] {
      for (const AcceleratorType& type : accelerator_types())
        world_for<double>(scene->parts(), type, 0, build_ms);
    });
  }
  EXPECT_GT(scene->bytes(), 2 * bare);
  EXPECT_EQ(store->bytes(), bare);
  EXPECT_NE(store.scenes.find(scene->scene().id), scene) << "a new object without structures";
  EXPECT_GT(store.work.bytes(), bare) << "charged while the old object is used";
}

TEST(SceneStore, ChargesBuiltStructuresToStore) {
  Store store(1 << 30);
  const auto scene = store.keep(balls("kept", 2000)).scene;
  const auto other = store.get(balls("cached", 2000));
  for (const auto& some : {scene, other}) {
    const SceneStore::SizeGuard measured(store.scenes, *some);
    double build_ms = 0;
    store.work.open("builder")->run(
        {}, [&] { world_for<float>(some->parts(), accelerator_types()[0], 0, build_ms); });
  }
  EXPECT_EQ(store.work.bytes(), 0u) << "the store is charged instead";
  EXPECT_EQ(store->bytes(), scene->bytes() + other->bytes());
}

}  // namespace
}  // namespace orrery
