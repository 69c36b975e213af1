# cmake -DFUZZER=... -DFOLDER=... -DSECONDS=... -P fuzz.cmake: runs a fuzzer over a small corpus of its own. What it
# finds stays in FOLDER.
cmake_policy(VERSION 3.25)
file(REMOVE_RECURSE ${FOLDER})
file(MAKE_DIRECTORY ${FOLDER}/corpus)

# The first letter is the format: see mesh_import_fuzz.cpp. A tetrahedron in each.
set(vertices "0 0 0\n9 0 0\n0 9 0\n0 0 9\n")
set(faces "3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n")
set(head "element vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement face 4\n")
string(APPEND head "property list uchar int vertex_indices\nend_header\n")
file(WRITE ${FOLDER}/corpus/off "oOFF\n4 4 0\n${vertices}${faces}")
file(WRITE ${FOLDER}/corpus/obj "wv 0 0 0\nv 9 0 0\nv 0 9 0\nv 0 0 9\nv 9 9 0\nf 1 3 2\nf 1/2 2//4 4\nf -2 3 4 5\n")
file(WRITE ${FOLDER}/corpus/ply "pply\nformat ascii 1.0\n${head}${vertices}${faces}")
file(WRITE ${FOLDER}/corpus/ply_little "pply\nformat binary_little_endian 1.0\n${head}aaaabbbbccccddddeeeeffffgggghhhh")
file(WRITE ${FOLDER}/corpus/ply_big "pply\nformat binary_big_endian 1.0\n${head}aaaabbbbccccddddeeeeffffgggghhhh")
set(facet "facet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 9 0 0\nvertex 0 9 0\nendloop\nendfacet\n")
file(WRITE ${FOLDER}/corpus/stl "ssolid a\n${facet}${facet}endsolid a\n")
string(REPEAT "aaaabbbbcc" 15 records)
file(WRITE ${FOLDER}/corpus/stl_binary "b${records}")
# For field_bytes_fuzz.cpp.
file(WRITE ${FOLDER}/corpus/edits "eaaaa1aabb2qrst3")
file(WRITE ${FOLDER}/corpus/cut "taaaabbbb1")

execute_process(
  COMMAND ${FUZZER} -max_total_time=${SECONDS} -max_len=8192 -timeout=20 -rss_limit_mb=2000 -seed=1
    -print_final_stats=1 -artifact_prefix=${FOLDER}/ ${FOLDER}/corpus
  RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
string(REGEX MATCHALL "stat::[^\n]*" stats "${output}")
list(JOIN stats "\n" stats)
message("${stats}")
if(NOT result EQUAL 0)
  message(FATAL_ERROR "${FUZZER} found something:\n${output}")
endif()
