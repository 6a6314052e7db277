# Makes the manual page of the program's own help: cmake -D PROGRAM=… -D PAGE=… -P man_page.cmake
execute_process(COMMAND ${PROGRAM} --help OUTPUT_VARIABLE help RESULT_VARIABLE status)
execute_process(COMMAND ${PROGRAM} --version OUTPUT_VARIABLE version)
if(NOT status EQUAL 0)
  message(FATAL_ERROR "`${PROGRAM} --help` ended with ${status}")
endif()
string(REGEX REPLACE "\\(git.*" "" version "${version}")
string(STRIP "${version}" version)
string(REPLACE "\\" "\\e" help "${help}")
string(REPLACE "-" "\\-" help "${help}")
string(REGEX REPLACE "\n([.'])" "\n\\\\&\\1" help "${help}")
file(WRITE ${PAGE} ".TH CILIAVAL 1 \"\" \"${version}\"
.SH NAME
ciliaval \\- cross\\-validation of models of magnetic\\-cilium tactile sensors
.SH DESCRIPTION
.nf
${help}
.fi
Each command has its own help: ciliaval COMMAND \\-\\-help.
")
