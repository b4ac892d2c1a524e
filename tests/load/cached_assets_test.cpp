#include "core/load/cached_assets.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "core/params/json.h"
#include "core/params/params.h"
#include "core/textures/image_map.h"
#include "core/textures/registry.h"

namespace orrery {
namespace {

using testing::HasSubstr;

// Source of white images of any name, which counts them.
class WhiteImages final : public AssetSource {
 public:
  TexelsPtr picture_file(const std::string&) const override {
    ++count;
    return std::make_shared<const Texels>(Texels{4, 2, std::vector<float>(24, 1)});
  }
  mutable int count = 0;
};

// Source that notes the levels of another.
class NotedLevels final : public AssetSource {
 public:
  explicit NotedLevels(const AssetSource& from) : from_(from) {}
  TexelsPtr picture_file(const std::string& name) const override { return from_.picture_file(name); }
  ImageLevelsPtr levels(const std::string& key, const std::function<ImageLevelsPtr()>& make) const override {
    return *all.insert(from_.levels(key, make)).first;
  }
  mutable std::set<ImageLevelsPtr> all;

 private:
  const AssetSource& from_;
};

ImageLevelsPtr levels_of(const AssetSource& assets, const std::string& name) {
  return assets.levels(name, [&] { return std::make_shared<const ImageLevels>(assets.picture_file(name)); });
}

TEST(CachedAssetSource, KeepsLevelsByKey) {
  const WhiteImages images;
  const CachedAssetSource assets(images);
  const ImageLevelsPtr levels = levels_of(assets, "a");
  EXPECT_EQ(levels_of(assets, "a"), levels);
  EXPECT_NE(levels_of(assets, "b"), levels);
  EXPECT_EQ(levels->texels(), 8);
}

TEST(CachedAssetSource, LimitsTheTexelsOfAllTextures) {
  const WhiteImages images;
  const CachedAssetSource assets(images, 16);
  EXPECT_NE(levels_of(assets, "a"), nullptr);
  EXPECT_NE(levels_of(assets, "b"), nullptr);
  EXPECT_NE(levels_of(assets, "b"), nullptr);
  try {
    levels_of(assets, "c");
    FAIL() << "24 texels were accepted";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("more than 16 texels (limit 16, texture_texels)"));
  }
  EXPECT_EQ(levels_of(assets, "d"), nullptr);
  EXPECT_EQ(images.count, 3);
}

// Textures differ in their use of an image, which is kept once for each encoding.
TEST(CachedAssetSource, SharesImagesAmongTextures) {
  const WhiteImages images;
  const CachedAssetSource assets(images);
  const NotedLevels noted(assets);
  for (const char* text : {R"({"type": "image", "file": "a.png"})",
                           R"({"type": "image", "file": "a.png", "wrap": "clamp", "scale": 0.5})",
                           R"({"type": "image", "file": "a.png", "encoding": "alpha"})",
                           R"({"type": "image", "file": "a.png", "encoding": "alpha"})"})
    read_document(parse_document(text), [&](Params& p) {
      p.text("type", "", 10);
      EXPECT_NE(texture_types()[1].read(p, noted), nullptr);
    });
  EXPECT_EQ(noted.all.size(), 2);
}

}  // namespace
}  // namespace orrery
