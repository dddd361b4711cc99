// SPDX-License-Identifier: MIT
#pragma once

#include "assimp/SmallFbx.h"

#include <osgGpuAnimation/animation/Skin.h>
#include <string>

namespace osgGpuAnimation
{

/// FBX 7.4 in centimetres, z upwards: a triangle on a node that is scaled by 100 below a shelf; a bone moves all of it,
/// and at rest it leaves it where it is: (2, 3, 0), (3, 3, 0) and (2, 4, 0) m in glTF's axes.
inline std::string skinnedFbx()
{
    return fbxHeader(2, 1, -1) + R"(Objects:  {
	Model: 1, "Model::bone", "LimbNode" {
		Properties70:  {
			P: "Lcl Translation", "Lcl Translation", "", "A",0,0,150
		}
	}
	Model: 2, "Model::shelf", "Null" {
		Properties70:  {
			P: "Lcl Translation", "Lcl Translation", "", "A",200,0,0
		}
	}
	Model: 3, "Model::sheet", "Mesh" {
		Properties70:  {
			P: "Lcl Translation", "Lcl Translation", "", "A",0,0,300
			P: "Lcl Scaling", "Lcl Scaling", "", "A",100,100,100
		}
	}
	Geometry: 4, "Geometry::", "Mesh" {
		Vertices: *9 {
			a: 0,0,0,1,0,0,0,0,1
		}
		PolygonVertexIndex: *3 {
			a: 0,1,-3
		}
	}
	Deformer: 5, "Deformer::", "Skin" {
	}
	Deformer: 6, "SubDeformer::", "Cluster" {
		Indexes: *3 {
			a: 0,1,2
		}
		Weights: *3 {
			a: 1,1,1
		}
		Transform: *16 {
			a: 100,0,0,0,0,100,0,0,0,0,100,0,200,0,150,1
		}
		TransformLink: *16 {
			a: 1,0,0,0,0,1,0,0,0,0,1,0,0,0,150,1
		}
	}
}
Connections:  {
	C: "OO",1,0
	C: "OO",2,0
	C: "OO",3,2
	C: "OO",4,3
	C: "OO",5,4
	C: "OO",6,5
	C: "OO",1,6
}
)";
}

/// Doom 3: an arm of two bones, 2 units each, with one triangle at each bone; material `arm.tga`.
inline std::string md5Mesh()
{
    return R"(MD5Version 10
commandline ""

numJoints 2
numMeshes 1

joints {
	"upper"	-1 ( 0 0 0 ) ( 0 0 0 )
	"lower"	0 ( 0 0 2 ) ( 0 0.38268343 0 )
}

mesh {
	shader "arm"

	numverts 6
	vert 0 ( 0 0 ) 0 1
	vert 1 ( 1 0 ) 1 1
	vert 2 ( 0 1 ) 2 2
	vert 3 ( 1 1 ) 4 1
	vert 4 ( 0.5 0 ) 5 1
	vert 5 ( 0.25 0.75 ) 6 1

	numtris 2
	tri 0 0 1 2
	tri 1 3 4 5

	numweights 7
	weight 0 0 1 ( 0.5 0 0 )
	weight 1 0 1 ( -0.5 0 0 )
	weight 2 0 0.25 ( 0 0 2 )
	weight 3 1 0.75 ( 0 0 0.5 )
	weight 4 1 1 ( 0.5 0.5 1 )
	weight 5 1 1 ( -0.5 0 1.5 )
	weight 6 1 1 ( 0 -0.5 2 )
}
)";
}

/// Four frames at 24 a second: the upper bone moves and turns about x, the lower one about y.
inline std::string md5Anim()
{
    return R"(MD5Version 10
commandline ""

numFrames 4
numJoints 2
frameRate 24
numAnimatedComponents 4

hierarchy {
	"upper"	-1 10 0
	"lower"	0 20 2
}

bounds {
	( -5 -5 -5 ) ( 5 5 5 )
	( -5 -5 -5 ) ( 5 5 5 )
	( -5 -5 -5 ) ( 5 5 5 )
	( -5 -5 -5 ) ( 5 5 5 )
}

baseframe {
	( 0 0 0 ) ( 0 0 0 )
	( 0 0 2 ) ( 0 0 0 )
}

frame 0 {
	0 0 0.1 0.2
}

frame 1 {
	0.5 0.2 0.2 0.4
}

frame 2 {
	1 0.4 0 0.1
}

frame 3 {
	0 0 -0.3 -0.2
}
)";
}

} // namespace osgGpuAnimation
