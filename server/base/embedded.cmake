# orrery_embed(<out.cpp> <file>...): generates a source file that defines embedded_files() of embedded.h for
# the given files (paths from the repository root). The assembler includes the bytes (.incbin), so that large
# files take no time to compile. The object is rebuilt when a file changes.
function(orrery_embed out)
  list(SORT ARGN)
  list(LENGTH ARGN count)
  set(inputs "")
  set(assembly "")
  set(symbols "")
  set(table "")
  set(index 0)
  foreach(path IN LISTS ARGN)
    set(input ${PROJECT_SOURCE_DIR}/${path})
    list(APPEND inputs ${input})
    string(APPEND assembly "    \".balign 16\\n\"\n")
    string(APPEND assembly "    \"embedded_${index}: .incbin \\\"${input}\\\"\\n\"\n")
    string(APPEND assembly "    \"embedded_${index}_end: .byte 0\\n\"\n")
    string(APPEND symbols "extern ORRERY_HIDDEN const char embedded_${index}[], embedded_${index}_end[];\n")
    string(APPEND table "      file(\"${path}\", embedded_${index}, embedded_${index}_end),\n")
    math(EXPR index "${index} + 1")
  endforeach()
  file(CONFIGURE OUTPUT ${out} @ONLY CONTENT [==[
#include "server/base/embedded.h"

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
  # A unity build would lose OBJECT_DEPENDS.
  set_source_files_properties(${out} PROPERTIES OBJECT_DEPENDS "${inputs}" SKIP_UNITY_BUILD_INCLUSION ON)
endfunction()
