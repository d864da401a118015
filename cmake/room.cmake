# verdure_room(NAME SOURCES ... LINK ... PRIVATE_LINK ...)
# One room of the house: a static library verdure_NAME (verdure::NAME) with the
# project's warnings. LINK is what its headers need, PRIVATE_LINK what only its
# sources need.
add_library(verdure_warnings INTERFACE)
target_compile_options(verdure_warnings INTERFACE -Wall -Wextra -Wconversion -Wshadow)
if(CMAKE_UNITY_BUILD)  # there, every file but the first is an included one
  target_compile_options(verdure_warnings INTERFACE -Wno-subobject-linkage)
endif()
if(VERDURE_SANITIZE)
  add_compile_options(-fsanitize=address,undefined -fno-sanitize-recover=undefined
                      -fno-omit-frame-pointer)
  add_link_options(-fsanitize=address,undefined)
endif()

function(verdure_room name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LINK;PRIVATE_LINK" ${ARGN})
  add_library(verdure_${name} STATIC ${ARG_SOURCES})
  add_library(verdure::${name} ALIAS verdure_${name})
  set_target_properties(verdure_${name} PROPERTIES EXPORT_NAME ${name})
  target_include_directories(
    verdure_${name}
    PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include>
           $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>
    PRIVATE ${PROJECT_SOURCE_DIR}/src)
  target_compile_features(verdure_${name} PUBLIC cxx_std_20)
  # GLM's experimental quaternion and hash headers are used; the flag is harmless elsewhere.
  target_compile_definitions(verdure_${name} PRIVATE GLM_ENABLE_EXPERIMENTAL)
  target_link_libraries(verdure_${name} PUBLIC ${ARG_LINK}
                        PRIVATE ${ARG_PRIVATE_LINK} $<BUILD_INTERFACE:verdure_warnings>)
  install(TARGETS verdure_${name} EXPORT verdureTargets
          ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
endfunction()
