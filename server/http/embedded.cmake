# orrery_embed(<out.cpp> <file>...): writes a source that defines embedded_files() of embedded.h over the
# given files (paths from the repository root). The assembler reads the bytes (.incbin), so a large file
# costs nothing to compile, and the object is rebuilt when one of them changes.
function(orrery_embed out)
  list(SORT ARGN)
  list(LENGTH ARGN count)
  set(assembly "")
  set(symbols "")
  set(table "")
  set(index 0)
  foreach(path IN LISTS ARGN)
    string(APPEND assembly "    \".balign 16\\n\"\n")
    string(APPEND assembly "    \"embedded_${index}: .incbin \\\"${PROJECT_SOURCE_DIR}/${path}\\\"\\n\"\n")
    string(APPEND assembly "    \"embedded_${index}_end: .byte 0\\n\"\n")
    string(APPEND symbols "extern ORRERY_HIDDEN const char embedded_${index}[], embedded_${index}_end[];\n")
    string(APPEND table "      file(\"${path}\", embedded_${index}, embedded_${index}_end),\n")
    math(EXPR index "${index} + 1")
  endforeach()
  file(CONFIGURE OUTPUT ${out} @ONLY CONTENT [==[
#include "server/http/embedded.h"

#include <array>

#define ORRERY_HIDDEN __attribute__((visibility("hidden")))
asm(".pushsection .rodata\n"
@assembly@    ".popsection\n");
extern "C" {
@symbols@}

namespace orrery {
namespace {
[[maybe_unused]] EmbeddedFile file(const char* path, const char* begin, const char* end) {
  return {path, {begin, static_cast<std::size_t>(end - begin)}};
}
}  // namespace

std::span<const EmbeddedFile> embedded_files() {
  static const std::array<EmbeddedFile, @count@> files{
@table@  };
  return files;
}

}  // namespace orrery
]==])
  list(TRANSFORM ARGN PREPEND ${PROJECT_SOURCE_DIR}/ OUTPUT_VARIABLE inputs)
  set_source_files_properties(${out} PROPERTIES OBJECT_DEPENDS "${inputs}")
endfunction()
