# For libraries that come without a CMake package on one of the supported systems; the installed
# package of edgevox reads this file as well, so that it holds no path of where it was built.

# Makes the target edgevox::<name>. Without the library the build ends, and find_package(edgevox)
# does not find it; both say which package is missing.
macro(edgevox_find_library name header library debian_package)
  if(NOT TARGET edgevox::${name})
    find_path(edgevox_${name}_INCLUDE_DIR ${header})
    find_library(edgevox_${name}_LIBRARY ${library})
    mark_as_advanced(edgevox_${name}_INCLUDE_DIR edgevox_${name}_LIBRARY)
    if(edgevox_${name}_INCLUDE_DIR AND edgevox_${name}_LIBRARY)
      add_library(edgevox::${name} UNKNOWN IMPORTED)
      set_target_properties(edgevox::${name} PROPERTIES
        IMPORTED_LOCATION "${edgevox_${name}_LIBRARY}"
        INTERFACE_INCLUDE_DIRECTORIES "${edgevox_${name}_INCLUDE_DIR}")
    elseif(CMAKE_FIND_PACKAGE_NAME)
      set(${CMAKE_FIND_PACKAGE_NAME}_FOUND FALSE)
      set(${CMAKE_FIND_PACKAGE_NAME}_NOT_FOUND_MESSAGE
        "${header} or the library '${library}' was not found: install ${debian_package}.")
      return()
    else()
      message(FATAL_ERROR
        "${header} or the library '${library}' was not found: install ${debian_package}.")
    endif()
  endif()
endmacro()
