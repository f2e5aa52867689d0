// Files for the tests of the assimp reader: small ones that are good, and small ones that assimp 5.2 cannot
// survive.
#pragma once

#include <string_view>

/// A triangle that stands 5 above the ground.
constexpr std::string_view ac3d_file = R"(AC3Db
MATERIAL "green" rgb 0 1 0  amb 0 0 0  emis 0 0 0  spec 0 0 0  shi 10  trans 0
OBJECT world
kids 1
OBJECT poly
name "tri"
loc 0 0 5
numvert 3
0 0 0
1 0 0
0 1 0
numsurf 1
SURF 0x0
mat 0
refs 3
0 0 0
1 1 0
2 0 1
kids 0
)";

/// assimp reads its vertex 77777777: SIGSEGV.
constexpr std::string_view crashing_ase = R"(*3DSMAX_ASCIIEXPORT 200
*GEOMOBJECT {
	*NODE_NAME "a"
	*MESH {
		*MESH_NUMVERTEX 3
		*MESH_NUMFACES 1
		*MESH_VERTEX_LIST {
			*MESH_VERTEX 0 0 0 0
			*MESH_VERTEX 1 1 0 0
			*MESH_VERTEX 2 0 1 0
		}
		*MESH_FACE_LIST {
			*MESH_FACE 0: A: 77777777 B: 1 C: 2 AB: 1 BC: 1 CA: 1 *MESH_SMOOTHING 0 *MESH_MTLID 0
		}
	}
}
)";

/// assimp asks for the first of no vertices: SIGABRT, from an assertion of the standard library.
constexpr std::string_view aborting_nff = "f 1 0 0 1 0 0 0 0\np 0\n0 0 0\n1 0 0\n0 1 0\ns 0 0 0 1\n";

/// A sphere of 20 * 4^12 triangles.
constexpr std::string_view huge_nff = "f 1 0 0 1 0 0 0 0\ntess 12\ns 0 0 0 1\n";

/// assimp waits at the end of the file for the name of node 0, for ever.
constexpr std::string_view endless_smd = "version 1\nnodes\n0\n";
