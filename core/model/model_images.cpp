#include "core/model/model_images.h"

#include "core/image/decode/picture.h"
#include "core/meshes/note_list.h"
#include "core/meshes/text.h"

namespace orrery {

bool is_shown(const ModelImage& image) { return is_picture(*image.bytes); }

std::vector<std::string> notes_of(const MeshModel& model) {
  constexpr std::size_t kMaxNotes = 20, kNameBytes = 80;  // about images
  std::vector<std::string> notes = model.mesh.notes;
  NoteList hidden(kMaxNotes, " more images are not shown");
  for (const ModelImage& image : model.images)
    if (!is_shown(image))
      hidden.add("image " + excerpt(image.name, kNameBytes) +
                 " is not shown: it must be an EXR, Radiance HDR, PNG, JPEG or WebP file");
  hidden.move_to(notes);
  return notes;
}

}  // namespace orrery
