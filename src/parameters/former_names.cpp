#include "parameters/former_names.hpp"

#include <vector>

namespace lockstep {

namespace {

struct FormerName {
  std::string list;  ///< one of those on the path to it, or the table of a column; empty: any
  std::string name;
  std::string fate;
};

const std::vector<FormerName>& former_names() {
  static const std::vector<FormerName> names = {
      // Contact.
      {"Contact", "Iterations", "is called \"Maximum Iterations\" now"},
      {"Contact", "Shell Thickness", "is called \"Thickness\" now"},
      {"Contact", "Wall Friction", "is called \"Friction\" now and stands in the list \"Walls\""},
      {"Contact", "Wall Restitution",
       "is called \"Restitution\" now and stands in the list \"Walls\""},
      {"Contact", "Margin", "is always 0.1 cells now: leave it out"},
      {"Contact", "Slop", "is always 0.05 cells now: leave it out"},
      {"Contact", "Deepest Overlap", "is always half a cell now: leave it out"},
      {"Contact", "Push Out Rate", "is always 0.2 now: leave it out"},
      {"Contact", "Bounce Speed", "is always 1 mm/s now: leave it out"},
      {"Contact", "Between Jointed Solids", "is gone: solids that a joint connects never touch"},
      {"Contact", "Self-Contact", "is gone: what is not rigid always touches itself"},
      // Studies.
      {"", "Extrapolate", "is always done now where the order is clean: leave it out"},
      // Solids.
      {"", "Orientation", "is called \"Rotation\" now: in 3D axis times angle, no quaternion"},
      {"", "Rotation Axis", "is gone: \"Rotation\" is axis times angle"},
      {"", "Rotation Angle", "is gone: \"Rotation\" is axis times angle"},
      {"", "Surface Spacing", "is called \"Mesh Spacing\" now"},
      {"", "Worst Quality", "is always 0.001 now: leave it out"},
      {"", "Shear Ratio", "is always 0.5 now: leave it out"},
      {"", "Stations", "is the first of the numbers of each of the \"Sections\" now"},
      {"", "Half Heights", "is the second of the numbers of each of the \"Sections\" now"},
      {"", "Half Widths", "is the third of the numbers of each of the \"Sections\" now"},
      {"", "Directions", "is called \"Locked\" now"},
      {"", "Release Time", "is called \"End\" now"},
      {"", "Load", "is gone: \"Force\" and \"Torque\" may be formulas, with table(t, ...)"},
      {"Solids", "Tension Only", "is gone: a spring that only pulls is of type \"rope\""},
      // Joints.
      {"Joints", "Lower Limit", "is called \"Lower\" now and stands in the list \"Limits\""},
      {"Joints", "Upper Limit", "is called \"Upper\" now and stands in the list \"Limits\""},
      {"Joints", "Middle", "is called \"Value\" now"},
      {"Joints", "Wave Length", "is called \"Wavelength\" now"},
      // Fluid.
      {"", "Begin Time", "is called \"Start\" now"},
      {"", "End Time", "is called \"End\" now"},
      {"Fluid", "Reference Temperature", "is the \"Ambient\" value of \"Temperature\" now"},
      {"Fluid", "Smoke Rate", "is gone: a source holds the \"Smoke\" inside it at a value"},
      {"Fluid", "Temperature Rate",
       "is gone: a source holds the \"Temperature\" inside it at a value"},
      {"Fluid", "Initial State",
       "is gone: the fluid's \"Velocity\" is that at the start, and may be formulas of the place"},
      // Water.
      {"Fluid", "Tension Integration", "is called \"Time Integration\" now"},
      {"Fluid", "Smallest Distance", "is always 1e-5 cells now: leave it out"},
      {"Fluid", "Crest", "is always 0 now: leave it out"},
      {"Fluid", "Band", "is always 6 cells now: leave it out"},
      {"Fluid", "Particle Band", "is always 3 cells now: leave it out"},
      {"Fluid", "Particles per Cell", "is always 16 now: leave it out"},
      {"Fluid", "Reseed Interval", "is always 20 steps now: leave it out"},
      {"Fluid", "Largest Shift", "is a constant now: leave it out"},
      {"Fluid", "Smallest Void", "is called \"Smallest Cavity\" now"},
      {"Fluid", "Crumbs",
       "is called \"Volume Correction\" now: \"component\" in place of \"return\", \"none\" in "
       "place of \"keep\""},
      {"Liquid", "Amplitude", "stands in the \"Height\" now: \"[0.5 + 0.1*cos(3*x)]\""},
      {"Liquid", "Wavelength", "stands in the \"Height\" now: \"[0.5 + 0.1*cos(3*x)]\""},
      {"Sides", "Profile",
       "is gone: \"Velocity\" may be a formula of the place, a parabola \"[6*y*(1 - y)]\""},
      {"Sides", "Ramp Time",
       "is gone: \"Velocity\" may be a formula of the time, a ramp \"[min(t, 1)]\", and a \"Wave\" "
       "has its own"},
      {"Sides", "End", "is gone: \"Velocity\" may be a formula of the time, \"[t < 1 ? 2 : 0]\""},
      {"Wave", "Period", "is \"Frequency\" now, one over it"},
      {"Wave", "Depth", "is that of the domain now: leave it out"},
      {"Wave", "Level", "is the \"Height\" of the fluid's \"Liquid\" now: leave it out"},
      // Couplings and solvers.
      {"Coupling", "Balance Masses", "is called \"Correct Buoyancy\" now"},
      {"Coupling", "Soft Weights", "is called \"Weights\" now"},
      {"Solver", "Viscous Tolerance",
       "is called \"Tolerance\" now and stands in the list \"Viscous Solve\""},
      {"", "Krylov Method",
       "is gone: a list of the strategy \"stratimikos\" names a method of Belos"},
      {"", "Krylov Solver", "is gone: viscosity is solved for by conjugate gradients"},
      {"", "Largest Solid", "is always 18 now: leave it out"},
      {"", "Maximum Unknowns", "is always 300000 now: leave it out"},
      // Scenes and studies.
      {"View", "Centre", "is called \"Center\" now"},
      {"Copies", "Number", "is called \"Count\" now"},
      {"Copies", "Positions", "is called \"Points\" now"},
      {"Copies", "Smallest Distance", "is called \"Spacing\" now"},
      {"Observers", "Foot", "is the first of the two \"Points\" now"},
      {"Observers", "Head", "is the second of the two \"Points\" now"},
      {"Samples", "Number", "is called \"Count\" now"},
      {"Quantities", "From Time", "is called \"Start\" now"},
      {"Quantities", "Exact", "is called \"Reference\" now"},
      {"Curves", "Exact", "is called \"Reference\" now"},
      {"Quantities", "Norm", "is called \"Over\" now"},
      {"Quantities", "Component", "stands in the name of the \"Field\" now: \"velocity[1]\""},
      {"Output", "Checkpoint Interval",
       "is called \"Interval\" now and stands in the list \"Checkpoints\""},
      {"Output", "Keep Checkpoints",
       "is called \"Count\" now and stands in the list \"Checkpoints\""},
      {"", "Ranks", "is the constant \"ranks\" now, in the list \"Constants\""},
      // Columns.
      {"history.csv", "gas_pockets", "is called \"gas_bubbles\" now"},
      {"history.csv", "lever_impulse_x", "is called \"lumping_torque_error_x\" now"},
      {"history.csv", "lever_impulse_y", "is called \"lumping_torque_error_y\" now"},
      {"history.csv", "lever_impulse_z", "is called \"lumping_torque_error_z\" now"},
  };
  return names;
}

}  // namespace

std::string fate_of(const std::string& path, const std::string& name) {
  const std::string lists = "/" + path + "/";
  for (const FormerName& former : former_names()) {
    const bool is_there =
        former.list.empty() || lists.find("/" + former.list + "/") != std::string::npos;
    if (former.name == name && is_there)
      return former.fate;
  }
  return "";
}

}  // namespace lockstep
