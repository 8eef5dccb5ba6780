# Sources of the advection along u_ADV and of the revalidation.
set(TRANSPORT_SOURCES
  field_carrier.cpp box_bins.cpp nearby_surface.cpp ray_halo.cpp revalidation.cpp sample_lattice.cpp surface_transport.cpp
  tile_block.cpp transport.cpp visible_interpolation.cpp)
# gcc 12 takes the undefined operand of AVX-512 intrinsics in Eigen for a mistake.
set_source_files_properties(tile_block.cpp field_carrier.cpp
  PROPERTIES COMPILE_OPTIONS "-Wno-uninitialized;-Wno-maybe-uninitialized")
