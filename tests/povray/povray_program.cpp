#include "tests/povray/povray_program.h"

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <limits>
#include <stdexcept>

namespace orrery {
namespace {

// Returns the next word of a PPM header. A word that begins with # starts a comment.
std::string header_word(std::istream& in) {
  std::string word;
  while (in >> word && word[0] == '#') in.ignore(std::numeric_limits<std::streamsize>::max(), '\n');
  return word;
}

// Reads a binary PPM with 16 bits per channel, most significant byte first. Throws std::runtime_error for
// other files.
Picture read_ppm(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  const std::string magic = header_word(in);
  const int width = std::atoi(header_word(in).c_str()), height = std::atoi(header_word(in).c_str());
  const std::string largest = header_word(in);
  in.get();
  if (magic != "P6" || largest != "65535" || width <= 0 || height <= 0)
    throw std::runtime_error(path + ": must be a binary PPM with 16 bits per channel");
  Picture picture(width, height);
  std::string bytes(picture.pixels.size() * 6, '\0');
  in.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (!in) throw std::runtime_error(path + ": file ends early");
  const auto value = [&](std::size_t i) {
    const auto high = static_cast<unsigned char>(bytes[2 * i]),
               low = static_cast<unsigned char>(bytes[2 * i + 1]);
    return static_cast<float>(high * 256 + low) / 65535.0f;
  };
  for (std::size_t i = 0; i < picture.pixels.size(); ++i)
    picture.pixels[i] = {value(3 * i), value(3 * i + 1), value(3 * i + 2)};
  return picture;
}

}  // namespace

bool povray_is_installed() { return std::system("command -v povray >/dev/null 2>&1") == 0; }

Picture run_povray(const std::string& folder, int width, int height) {
  const std::string base = folder + "/povray", log = base + ".log";
  const std::string command = "povray +I" + base + ".pov +O" + base +
                              ".ppm +FP16 File_Gamma=1.0 -A -D -GA +W" + std::to_string(width) + " +H" +
                              std::to_string(height) + " >" + log + " 2>&1";
  if (std::system(command.c_str()) != 0) throw std::runtime_error("cannot run povray: see " + log);
  Picture picture = read_ppm(base + ".ppm");
  if (picture.width != width || picture.height != height)
    throw std::runtime_error("image by povray must have the requested size");
  return picture;
}

}  // namespace orrery
