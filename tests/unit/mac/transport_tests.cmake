lockstep_test(mac_transport
  SOURCES test_transport.cpp test_transport_surfaces.cpp
  DEPENDS Lockstep::lockstep_mac
  RANKS 1 2 4 LABELS unit)
