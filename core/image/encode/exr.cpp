#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cstring>

#include "core/image/encode/codecs.h"

namespace orrery {
namespace {

class StringStream final : public Imf::OStream {
 public:
  explicit StringStream(std::string& out) : OStream("memory"), out_(out) {}
  void write(const char* bytes, int count) override {
    const auto size = static_cast<std::size_t>(count);
    if (out_.size() < position_ + size) out_.resize(position_ + size);
    std::memcpy(out_.data() + position_, bytes, size);
    position_ += size;
  }
  std::uint64_t tellp() override { return position_; }
  void seekp(std::uint64_t position) override { position_ = position; }

 private:
  std::string& out_;
  std::size_t position_ = 0;
};

class MemoryStream final : public Imf::IStream {
 public:
  explicit MemoryStream(std::span<const std::byte> bytes) : IStream("memory"), bytes_(bytes) {}
  bool read(char* to, int count) override {
    const auto size = static_cast<std::size_t>(count);
    if (position_ > bytes_.size() || bytes_.size() - position_ < size)
      throw std::runtime_error("data ends early");
    std::memcpy(to, bytes_.data() + position_, size);
    position_ += size;
    return position_ < bytes_.size();
  }
  std::uint64_t tellg() override { return position_; }
  void seekg(std::uint64_t position) override { position_ = position; }

 private:
  std::span<const std::byte> bytes_;
  std::size_t position_ = 0;
};

constexpr std::array kChannels = {"R", "G", "B"};

Imf::FrameBuffer frame_of(std::byte* first, int width) {
  Imf::FrameBuffer frame;
  for (std::size_t c = 0; c < kChannels.size(); ++c)
    frame.insert(kChannels[c],
                 Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(first) + c * sizeof(float), 3 * sizeof(float),
                            3 * sizeof(float) * static_cast<std::size_t>(width)));
  return frame;
}

}  // namespace

std::string encode_exr(const Image& image, std::span<const ExrLayer> layers) {
  assert(image.format() == PixelFormat::linear32);
  std::string out;
  StringStream stream(out);
  Imf::Header header(image.width(), image.height());
  header.compression() = Imf::ZIP_COMPRESSION;
  for (const char* name : kChannels) header.channels().insert(name, Imf::Channel(Imf::FLOAT));
  for (const ExrLayer& layer : layers) header.channels().insert(layer.name, Imf::Channel(Imf::FLOAT));
  {
    Imf::OutputFile file(stream, header, 0);
    Imf::FrameBuffer frame =
        frame_of(const_cast<std::byte*>(image.bytes().data()), image.width());  // the encoder only reads it
    for (const ExrLayer& layer : layers)
      frame.insert(layer.name,
                   Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(const_cast<float*>(layer.values.data())),
                              sizeof(float), sizeof(float) * std::size_t(image.width())));
    file.setFrameBuffer(frame);
    constexpr int kRows = 64;  // a multiple of the 16 rows of a ZIP block
    for (int row = 0; row < image.height(); row += kRows) {
      checkpoint();
      file.writePixels(std::min(kRows, image.height() - row));
    }
  }
  return out;
}

Image decode_exr(std::span<const std::byte> bytes, std::size_t max_pixels) try {
  MemoryStream stream(bytes);
  Imf::InputFile file(stream, 0);
  const auto window = file.header().dataWindow();
  const auto width = static_cast<std::size_t>(std::int64_t{window.max.x} - window.min.x + 1);
  const auto height = static_cast<std::size_t>(std::int64_t{window.max.y} - window.min.y + 1);
  check_size(width, height, max_pixels);
  Image image(static_cast<int>(width), static_cast<int>(height), PixelFormat::linear32);
  std::memset(image.bytes().data(), 0, image.bytes().size());
  const std::ptrdiff_t origin =
      (std::ptrdiff_t{window.min.y} * static_cast<std::ptrdiff_t>(width) + window.min.x) * 3 *
      std::ptrdiff_t{sizeof(float)};
  file.setFrameBuffer(frame_of(image.bytes().data() - origin, image.width()));
  file.readPixels(window.min.y, window.max.y);
  return image;
} catch (const InputError&) {
  throw;
} catch (const std::exception& error) {
  throw damaged("EXR", error.what());
}

}  // namespace orrery
