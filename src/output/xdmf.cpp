#include "output/xdmf.hpp"

#include <cctype>

#include "base/errors.hpp"
#include "base/xml_text.hpp"

namespace lockstep::xdmf {

namespace {

std::string data_item(const std::string& extents, const std::string& type, int bytes,
                      const std::string& where) {
  return fmt::format(
      "<DataItem Dimensions=\"{}\" NumberType=\"{}\" Precision=\"{}\" "
      "Format=\"HDF\">{}</DataItem>",
      extents, type, bytes, where);
}

const char* attribute_type(int n_components) {
  if (n_components == 1)
    return "Scalar";
  return n_components == 6 ? "Tensor6" : "Vector";
}

/// The last extent of a field's array; scalars have none.
std::string components(int n_components) {
  if (n_components == 1)
    return "";
  return n_components == 6 ? " 6" : " 3";
}

std::string attribute(const std::string& name, const std::string& unit, int n_components,
                      const std::string& center, const std::string& item) {
  return fmt::format(
      "        <Attribute Name=\"{}\" AttributeType=\"{}\" Center=\"{}\">\n"
      "          <Information Name=\"unit\" Value=\"{}\"/>\n"
      "          {}\n"
      "        </Attribute>\n",
      xml_escaped(name), attribute_type(n_components), center, xml_escaped(unit), item);
}

int bytes_of(Precision precision) {
  return precision == Precision::single_precision ? 4 : 8;
}

std::string triple(double z, double y, double x) {
  return fmt::format(
      "<DataItem Dimensions=\"3\" NumberType=\"Float\" Precision=\"8\" "
      "Format=\"XML\">{:.17g} {:.17g} {:.17g}</DataItem>",
      z, y, x);
}

std::string topology_type(int simplex_size) {
  if (simplex_size == 1)
    return "TopologyType=\"Polyvertex\" NodesPerElement=\"1\"";
  if (simplex_size == 2)
    return "TopologyType=\"Polyline\" NodesPerElement=\"2\"";
  return simplex_size == 3 ? "TopologyType=\"Triangle\"" : "TopologyType=\"Tetrahedron\"";
}
}  // namespace

std::string stored_name(const std::string& name) {
  std::string result = name;
  for (char& c : result) {
    const bool kept = std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' || c == '.';
    if (!kept)
      c = '_';
  }
  return result;
}

std::string box_grid(const BoxFrame& box, const std::string& file, Precision precision) {
  // ParaView's reader swaps the axes of a 2DCoRectMesh, so a plane is a slab one cell thick whose
  // top is z = 0.
  const bool flat = box.dimension == 2;
  const double thickness = flat ? box.spacing[0] : box.spacing[2];
  const double bottom = flat ? -thickness : box.origin[2];
  std::string text = fmt::format(
      "      <Grid Name=\"{}\" GridType=\"Uniform\">\n"
      "        <Topology TopologyType=\"3DCoRectMesh\" Dimensions=\"{} {} {}\"/>\n"
      "        <Geometry GeometryType=\"ORIGIN_DXDYDZ\">\n"
      "          {}\n"
      "          {}\n"
      "        </Geometry>\n",
      xml_escaped(box.name), box.n_cells[2] + 1, box.n_cells[1] + 1, box.n_cells[0] + 1,
      triple(bottom, box.origin[1], box.origin[0]),
      triple(thickness, box.spacing[1], box.spacing[0]));
  for (const BoxField& field : box.fields) {
    const std::string where =
        fmt::format("{}:/{}/{}", file, stored_name(box.name), stored_name(field.name));
    const std::string extents = fmt::format("{} {} {}{}", box.n_cells[2], box.n_cells[1],
                                            box.n_cells[0], components(field.n_components));
    text += attribute(field.name, field.unit, field.n_components, "Cell",
                      data_item(extents, "Float", bytes_of(precision), where));
  }
  return text + "      </Grid>\n";
}

std::string surface_grid(const SurfaceFrame& surface, const std::string& file,
                         Precision precision) {
  const std::size_t n_vertices = surface.vertices.size() / surface.dimension;
  const std::size_t n_simplices = surface.simplices.size() / surface.simplex_size;
  if (n_simplices == 0)
    return "";
  const std::string group = fmt::format("{}:/solids/{}/", file, stored_name(surface.name));
  const std::string corners = fmt::format("{} {}", n_simplices, surface.simplex_size);
  std::string text = fmt::format(
      "      <Grid Name=\"{}\" GridType=\"Uniform\">\n"
      "        <Topology {} NumberOfElements=\"{}\">\n"
      "          {}\n"
      "        </Topology>\n"
      "        <Geometry GeometryType=\"XYZ\">\n"
      "          {}\n"
      "        </Geometry>\n",
      xml_escaped(surface.name), topology_type(surface.simplex_size), n_simplices,
      data_item(corners, "Int", 4, group + "simplices"),
      data_item(fmt::format("{} 3", n_vertices), "Float", 8, group + "vertices"));
  for (const SurfaceField& field : surface.fields) {
    const bool on_vertices = field.place == SurfaceField::Place::vertices;
    const std::string extents =
        fmt::format("{}{}", on_vertices ? n_vertices : n_simplices, components(field.n_components));
    text += attribute(
        field.name, field.unit, field.n_components, on_vertices ? "Node" : "Cell",
        data_item(extents, "Float", bytes_of(precision), group + stored_name(field.name)));
  }
  return text + "      </Grid>\n";
}

std::string frame(double time, const std::string& grids) {
  return fmt::format(
      "    <Grid Name=\"frame\" GridType=\"Collection\" CollectionType=\"Spatial\">\n"
      "      <Time Value=\"{:.17g}\"/>\n{}    </Grid>\n",
      time, grids);
}

std::string document(const std::string& frames) {
  return fmt::format(
      "<?xml version=\"1.0\"?>\n"
      "<Xdmf Version=\"3.0\">\n"
      " <Domain>\n"
      "  <Grid Name=\"series\" GridType=\"Collection\" CollectionType=\"Temporal\">\n"
      "{}"
      "  </Grid>\n"
      " </Domain>\n"
      "</Xdmf>\n",
      frames);
}

}  // namespace lockstep::xdmf
