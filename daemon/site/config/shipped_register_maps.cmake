# The register maps that come with recald, as texts in the program: a gateway has one file to install.
file(GLOB register_maps CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/adapters/modbus/maps/*.toml)
list(SORT register_maps)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${register_maps})
set(SHIPPED_REGISTER_MAPS "")
foreach(file ${register_maps})
  get_filename_component(name ${file} NAME_WLE)
  file(READ ${file} text)
  string(APPEND SHIPPED_REGISTER_MAPS "    {\"${name}\", R\"map(${text})map\"},\n")
endforeach()
configure_file(${CMAKE_CURRENT_LIST_DIR}/shipped_register_maps.hpp.in
  ${CMAKE_BINARY_DIR}/generated/daemon/site/config/shipped_register_maps.hpp @ONLY)
