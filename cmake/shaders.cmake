# verdure_shaders(TARGET shader...): compiles each GLSL file with glslc when it or a header that it
# includes changes, and makes `shaders/NAME.inc` (the words of its SPIR-V, separated by commas)
# available to TARGET's sources.
function(verdure_shaders target)
  set(out ${CMAKE_CURRENT_BINARY_DIR}/spirv)
  foreach(shader ${ARGN})
    get_filename_component(name ${shader} NAME)
    set(inc ${out}/shaders/${name}.inc)
    add_custom_command(
      OUTPUT ${inc}
      COMMAND Vulkan::glslc --target-env=vulkan1.2 -O -Werror -mfmt=num -I${PROJECT_SOURCE_DIR}/src
              -MD -MF ${inc}.d -MT ${inc} -o ${inc} ${shader}
      DEPENDS ${shader}
      DEPFILE ${inc}.d
      COMMENT "glslc ${name}"
      VERBATIM)
    list(APPEND incs ${inc})
  endforeach()
  target_sources(${target} PRIVATE ${incs})
  target_include_directories(${target} PRIVATE ${out})
endfunction()
