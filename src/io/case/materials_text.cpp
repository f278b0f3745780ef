#include "io/case/materials_text.hpp"

// The assembler copies the file (as in report/bundle.cpp).
__asm__(
    ".pushsection .rodata\n"
    ".global breccia_materials\n"
    ".hidden breccia_materials\n"
    "breccia_materials:\n"
    ".incbin \"" BR_MATERIALS_FILE
    "\"\n"
    ".global breccia_materials_end\n"
    ".hidden breccia_materials_end\n"
    "breccia_materials_end:\n"
    ".byte 0\n"
    ".popsection\n");
extern "C" const char breccia_materials[], breccia_materials_end[];

namespace breccia {

std::string_view materials_text() {
  return {breccia_materials, static_cast<std::size_t>(breccia_materials_end - breccia_materials)};
}

}  // namespace breccia
