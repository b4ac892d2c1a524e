#include "server/cache/asset_store.h"

#include <gtest/gtest.h>

#include "core/base/hash.h"
#include "core/image/encode/files.h"

namespace orrery {
namespace {

std::string picture_file(int side) {
  const Image image(side, side, PixelFormat::srgb8);
  return encode_png(image);
}

TEST(AssetStore, DecodesImageOnceForAllScenes) {
  AssetStore store(1 << 20);
  const std::string file = picture_file(16), name = sha256_hex(file);
  store.add(name, file, "one");
  const TexelsPtr texels = store.picture_asset(name);
  EXPECT_EQ(texels->width, 16);
  EXPECT_EQ(store.picture_asset(name), texels);
  EXPECT_TRUE(store.add(name, file, "another").known);
  EXPECT_EQ(store.picture_asset(name), texels);
}

TEST(AssetStore, DoesNotCacheOversizedTexels) {
  AssetStore store(64 << 10);
  const std::string file = picture_file(128), name = sha256_hex(file);  // 196,608 bytes of texels
  store.add(name, file, "one");
  EXPECT_LT(store.bytes(), file.size() + 4096);
  EXPECT_EQ(store.picture_asset(name)->width, 128);
}

}  // namespace
}  // namespace orrery
