#pragma once

#include <string>

#include "tests/support/stored_zip.h"

/// glTF and 3MF files that mean harm, and sound ones to compare with.
namespace passung::test {

/// A 3MF package whose model has these resources and items.
inline std::string package(const std::string& resources, const std::string& items) {
    const std::string model =
        "<?xml version=\"1.0\"?><model unit=\"millimeter\" "
        "xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\"><resources>" +
        resources + "</resources><build>" + items + "</build></model>";
    return storedZip({{"_rels/.rels",
                       "<?xml version=\"1.0\"?><Relationships "
                       "xmlns=\"http://schemas.openxmlformats.org/package/2006/relationships\">"
                       "<Relationship Target=\"/3D/3dmodel.model\" Id=\"rel0\" "
                       "Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\"/></Relationships>"},
                      {"3D/3dmodel.model", model}});
}

/// A tetrahedron of 10 mm.
inline std::string tetrahedron(const std::string& id) {
    return "<object id=\"" + id +
           "\" type=\"model\"><mesh><vertices><vertex x=\"0\" y=\"0\" z=\"0\"/><vertex x=\"10\" y=\"0\" z=\"0\"/>"
           "<vertex x=\"0\" y=\"10\" z=\"0\"/><vertex x=\"0\" y=\"0\" z=\"10\"/></vertices><triangles>"
           "<triangle v1=\"0\" v2=\"2\" v3=\"1\"/><triangle v1=\"0\" v2=\"1\" v3=\"3\"/>"
           "<triangle v1=\"0\" v2=\"3\" v3=\"2\"/><triangle v1=\"1\" v2=\"2\" v3=\"3\"/></triangles></mesh></object>";
}

/// An object of `count` components, each the object `inner`.
inline std::string assembly(const std::string& id, const std::string& inner, int count) {
    std::string text = "<object id=\"" + id + "\" type=\"model\"><components>";
    for (int i = 0; i < count; ++i) text += "<component objectid=\"" + inner + "\"/>";
    return text + "</components></object>";
}

inline std::string item(const std::string& id) { return "<item objectid=\"" + id + "\"/>"; }

/// `levels` assemblies of ten of the one before: 10^levels tetrahedra.
inline std::string tens(int levels) {
    std::string resources = tetrahedron("1");
    for (int i = 0; i < levels; ++i) resources += assembly(std::to_string(i + 2), std::to_string(i + 1), 10);
    return package(resources, item(std::to_string(levels + 1)));
}

/// A glTF file of one triangle, with its nodes, length of buffer and number of vertices as said.
inline std::string gltfOf(const std::string& nodes, const std::string& byte_length = "36",
                          const std::string& count = "3", const std::string& extra = "") {
    return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":)" + nodes +
           R"(,"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"accessors":[{"bufferView":0,)"
           R"("componentType":5126,"count":)" +
           count + R"(,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}],"bufferViews":[{"buffer":0,"byteLength":36}],)" +
           R"("buffers":[{"byteLength":)" + byte_length +
           R"(,"uri":"data:application/octet-stream;base64,)"
           R"(AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}])" +
           extra + "}";
}

/// `levels` nodes, each with ten times the next one as its child; the last one has the mesh.
inline std::string nodesOfTens(int levels) {
    std::string nodes = "[";
    for (int i = 0; i < levels; ++i) {
        nodes += "{\"children\":[";
        for (int k = 0; k < 10; ++k) nodes += (k > 0 ? "," : "") + std::to_string(i + 1);
        nodes += "]},";
    }
    return nodes + "{\"mesh\":0}]";
}

/// A binary glTF file whose head says these lengths, of the file and of its JSON.
inline std::string glb(std::uint32_t length, std::uint32_t json_length, const std::string& json) {
    std::string bytes = "glTF";
    for (const std::uint32_t word : {2u, length, json_length, 0x4e4f534au})
        for (int k = 0; k < 4; ++k) bytes += static_cast<char>(word >> (8 * k) & 255u);
    return bytes + json;
}

/// A package one of whose entries says that it holds `bytes` unpacked.
inline std::string bomb(std::uint32_t bytes) {
    std::string archive = package(tetrahedron("1"), item("1"));
    const std::size_t local = archive.rfind("PK\x03\x04") + 22, central = archive.rfind("PK\x01\x02") + 24;
    for (const std::size_t at : {local, central})
        for (std::size_t k = 0; k < 4; ++k) archive[at + k] = static_cast<char>(bytes >> (8 * k) & 255u);
    return archive;
}

}  // namespace passung::test
