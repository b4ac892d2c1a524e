# cmake -DINPUT=<file> -DOUTPUT=<file> -P strip_text.cmake: copies a script or style sheet without comments and
# without indentation. A comment after code stays where it has quotes, which may be those of a text around it. Line
# numbers stay, for who reads an error in the browser. No text of the page may span lines: its indentation would be lost.
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
