# cmake -DINPUT=<file> -DOUTPUT=<file> -P strip_text.cmake: copies a script or style sheet without comments
# and indentation. Trailing comments with quotes stay, since the quotes may belong to a string around them.
# Line numbers stay the same, for error messages of browsers. String literals must not span lines, or they
# would lose their indentation.
file(READ ${INPUT} text)
set(text "\n${text}")
if(INPUT MATCHES "\\.css$")
  string(REGEX REPLACE "\n[ \t]*/\\*[^*]*\\*/" "\n" text "${text}")
else()
  string(REGEX REPLACE "\n[ \t]*//[^\n]*" "\n" text "${text}")
  string(REGEX REPLACE "[ \t]+// [^\n\"'`]*\n" "\n" text "${text}")
endif()
string(REGEX REPLACE "\n[ \t]+" "\n" text "${text}")
string(SUBSTRING "${text}" 1 -1 text)
file(WRITE ${OUTPUT} "${text}")
