"""Skeletons, skinned meshes with shapes, and animation of both in UsdSkel, both ways.

This is one of the two doors (the other is `exporters.usd`) at which our conventions meet USD's:
row vectors in matrices, and quaternions that print their real part first. In memory a
``GfQuatf`` lies as x, y, z, w, so that an array of ours is an array of USD's without a copy of
its own. Points, offsets, weights, rotations and translations are stored in single precision, rest
and bind transforms in double. What is defined is given in metres, Y up, and stored in the frame
that its stage says it has.

References
----------
.. [1] OpenUSD, "UsdSkel: Skeleton, Skinning and Animation Schemas",
   https://openusd.org/release/api/usd_skel_page_front.html
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from pxr import Gf, Sdf, Tf, Usd, UsdGeom, UsdShade, UsdSkel, Vt

from actions_library.naming import numbered
from actions_library.stage_frame import StageFrame
from smd.character.blend_shape import BlendShape
from smd.character.character import MAX_INFLUENCES, Character, Mesh
from smd.character.skeleton import Skeleton
from smd.character.tracks import NO_TRACKS, Tracks
from smd.errors import CharacterError
from smd.geometry.arrays import FloatArray, IntArray
from smd.geometry.rotations import matrix_from_quaternion, normalized

SKELETON, ANIMATION, MATERIALS = "Skeleton", "Animation", "Materials"
"""Names of the prims under a character's SkelRoot, beside its meshes."""

_ROLES = "smd:roles"

CONTROLS, CONTROL_VALUES = "smd:controls", "smd:controlValues"
"""Attributes of a SkelAnimation: names of tracks that no mesh has a shape for, and their values."""


def unique_identifiers(names: Iterable[str]) -> list[str]:
    """Return a valid USD prim name for each name, all different."""
    return numbered(Tf.MakeValidIdentifier(name) for name in names)


def joint_paths(skeleton: Skeleton) -> list[str]:
    """Return USD's name of each joint: the path from its root, as ``root/hips/spine``."""
    paths: list[str] = []
    for name, parent in zip(
        unique_identifiers(skeleton.joints), skeleton.parents.tolist(), strict=True
    ):
        paths.append(name if parent < 0 else f"{paths[parent]}/{name}")
    return paths


def vertex_normals(points_m: FloatArray, triangles: NDArray[np.int64]) -> FloatArray:
    """Return unit normals ``(p, 3)``: of the faces around each point, weighted by their area."""
    corners = points_m[triangles]
    face = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    summed = np.stack(
        [
            np.bincount(triangles.ravel(), np.repeat(face[:, axis], 3), minlength=len(points_m))
            for axis in range(3)
        ],
        axis=-1,
    )
    return normalized(summed)


def define_character(
    stage: Usd.Stage,
    path: str,
    character: Character,
    colors_rgb: Sequence[tuple[float, float, float]] | None = None,
    *,
    skeleton: str = SKELETON,
    animation: str = ANIMATION,
) -> UsdSkel.Root:
    """Define a SkelRoot with the character's skeleton, meshes and materials.

    Parameters
    ----------
    stage
        Where; its edit target's layer takes the opinions.
    path
        Of the SkelRoot.
    character
        What.
    colors_rgb
        Linear colour of each mesh instead of its own.
    skeleton, animation
        Names of the Skeleton's prim, and of a SkelAnimation's that is to stand beside it. Blender
        calls the armature and its action so.
    """
    root = UsdSkel.Root.Define(stage, path)
    bones = _define_skeleton(stage, f"{path}/{skeleton}", character.skeleton)
    binding = UsdSkel.BindingAPI.Apply(root.GetPrim())
    binding.CreateSkeletonRel().SetTargets([bones.GetPath()])
    colors = colors_rgb or [mesh.color_rgb for mesh in character.meshes]
    reserved = [skeleton, animation, MATERIALS]
    names = unique_identifiers([*reserved, *(mesh.name for mesh in character.meshes)])[3:]
    for name, mesh, color in zip(names, character.meshes, colors, strict=True):
        material = define_material(stage, f"{path}/{MATERIALS}/{name}", color)
        prim = _define_mesh(stage, f"{path}/{name}", mesh, color)
        UsdSkel.BindingAPI(prim).CreateSkeletonRel().SetTargets([bones.GetPath()])
        UsdShade.MaterialBindingAPI.Apply(prim.GetPrim()).Bind(material)
    return root


def define_material(
    stage: Usd.Stage, path: str, color_rgb: tuple[float, float, float], roughness: float = 0.6
) -> UsdShade.Material:
    """Define a UsdPreviewSurface of one colour."""
    UsdGeom.Scope.Define(stage, Sdf.Path(path).GetParentPath())
    material = UsdShade.Material.Define(stage, path)
    shader = UsdShade.Shader.Define(stage, f"{path}/Surface")
    shader.CreateIdAttr("UsdPreviewSurface")
    shader.CreateInput("diffuseColor", Sdf.ValueTypeNames.Color3f).Set(Gf.Vec3f(*color_rgb))
    shader.CreateInput("roughness", Sdf.ValueTypeNames.Float).Set(roughness)
    output = shader.CreateOutput("surface", Sdf.ValueTypeNames.Token)
    material.CreateSurfaceOutput().ConnectToSource(output)
    return material


def define_animation(
    stage: Usd.Stage,
    path: str,
    skeleton: Skeleton,
    rotation_xyzw: ArrayLike,
    translation_m: ArrayLike,
    frames: IntArray | None = None,
    *,
    tracks: Tracks = NO_TRACKS,
    shapes: Sequence[str] = (),
) -> UsdSkel.Animation:
    """Define a SkelAnimation with one sample a frame, frame i at time code i.

    Parameters
    ----------
    stage, path
        Where.
    skeleton
        Whose joints move.
    rotation_xyzw, translation_m
        Local poses ``(n, j, 4)``, unit, and ``(n, j, 3)``; stored in single precision.
    frames
        ``(k,)``, those that get a sample, in order; every frame by default.
    tracks
        Of as many frames as the poses.
    shapes
        Which of the tracks are weights of a character's shapes; others are stored as `CONTROLS`.
    """
    animation = UsdSkel.Animation.Define(stage, path)
    animation.CreateJointsAttr(joint_paths(skeleton))
    # Readers want all three of rotations, translations and scales, or show no pose at all.
    animation.CreateScalesAttr(Vt.Vec3hArray(len(skeleton), Gf.Vec3h(1.0)))
    frame = StageFrame.of(stage)
    rotations, translations = frame.rotations(rotation_xyzw), frame.points(translation_m)
    set_samples(animation.CreateRotationsAttr(), rotations, Vt.QuatfArray, frames)
    set_samples(animation.CreateTranslationsAttr(), translations, Vt.Vec3fArray, frames)
    weights, controls = tracks.among(shapes), tracks.without(shapes)
    if weights.names:
        animation.CreateBlendShapesAttr(list(weights.names))
        attribute = animation.CreateBlendShapeWeightsAttr()
        set_samples(attribute, weights.value, Vt.FloatArray, frames)
    if controls.names:
        prim, kinds = animation.GetPrim(), Sdf.ValueTypeNames
        names = prim.CreateAttribute(CONTROLS, kinds.TokenArray, True, Sdf.VariabilityUniform)
        names.Set(list(controls.names))
        attribute = prim.CreateAttribute(CONTROL_VALUES, kinds.FloatArray, True)
        set_samples(attribute, controls.value, Vt.FloatArray, frames)
    return animation


def bind_animation(
    root: UsdSkel.Root, animation: UsdSkel.Animation, skeleton: str = SKELETON
) -> None:
    """Let an animation move the character under ``root``, whose Skeleton has that name."""
    stage, path = root.GetPrim().GetStage(), animation.GetPath()
    # On the root it is inherited by all below; on the skeleton it is where other readers look.
    for prim in (root.GetPrim(), stage.OverridePrim(root.GetPath().AppendChild(skeleton))):
        UsdSkel.BindingAPI.Apply(prim).CreateAnimationSourceRel().SetTargets([path])


def set_samples(
    attribute: Usd.Attribute, values: ArrayLike, kind: Any, frames: IntArray | None = None
) -> None:
    """Give an attribute one array a frame: ``values (n, k, …)`` at codes 0 … n - 1.

    They are stored as they are, in the stage's own frame; where ``frames`` are given, those alone,
    and once where all of those are the same.

    Samples go to the layer directly, inside one change block: through the stage each would pay
    for resolution and notices.
    """
    single = np.ascontiguousarray(values, dtype=np.float32)
    if frames is not None and (single[frames] == single[frames[0]]).all():
        attribute.Set(kind.FromNumpy(single[frames[0]]))
        return
    target = attribute.GetStage().GetEditTarget()
    layer, path = target.GetLayer(), target.MapToSpecPath(attribute.GetPath())
    with Sdf.ChangeBlock():
        for frame in range(len(single)) if frames is None else frames.tolist():
            layer.SetTimeSample(path, float(frame), kind.FromNumpy(single[frame]))


def read_character(stage: Usd.Stage, name: str) -> Character:
    """Return the character under the stage's first SkelRoot, as `define_character` wrote it.

    Raises
    ------
    CharacterError
        If there is no SkelRoot, or its parts do not fit each other.
    """
    root = next((p for p in stage.Traverse() if p.IsA(UsdSkel.Root)), None)
    prims = list(Usd.PrimRange(root)) if root else []
    skeletons = [UsdSkel.Skeleton(p) for p in prims if p.IsA(UsdSkel.Skeleton)]
    if not skeletons:
        raise CharacterError("expected a SkelRoot with a Skeleton, found none")
    meshes = tuple(_read_mesh(UsdGeom.Mesh(p)) for p in prims if p.IsA(UsdGeom.Mesh))
    return Character(name=name, skeleton=_read_skeleton(skeletons[0]), meshes=meshes)


def read_animation(
    layer: Sdf.Layer, path: str, shapes: Sequence[str] = ()
) -> tuple[list[str], FloatArray, FloatArray, Tracks]:
    """Return the joints' paths, rotations ``(n, j, 4)`` xyzw, translations ``(n, j, 3)``, tracks.

    Parameters
    ----------
    layer, path
        Where the SkelAnimation is.
    shapes
        Those that its character has.

    Raises
    ------
    CharacterError
        If the layer has no such SkelAnimation, its samples are not of one shape, or there is a
        weight without a shape.
    """
    joints = layer.GetAttributeAtPath(f"{path}.joints")
    if joints is None or joints.default is None:
        raise CharacterError(f"expected a SkelAnimation with joints at {path}, found none")
    names = list(joints.default)
    rotation = _read_samples(layer, f"{path}.rotations", (len(names), 4))
    translation = _read_samples(layer, f"{path}.translations", (len(names), 3))
    weights = _read_tracks(layer, f"{path}.blendShapes", f"{path}.blendShapeWeights")
    if strange := weights.without(shapes).names:
        raise CharacterError(
            f"{path}.blendShapes: expected shapes of the character, got {strange[0]!r}"
        )
    controls = _read_tracks(layer, f"{path}.{CONTROLS}", f"{path}.{CONTROL_VALUES}")
    return names, rotation, translation, weights.beside(controls)


def _read_tracks(layer: Sdf.Layer, names: str, values: str) -> Tracks:
    """Return the tracks of two attributes, of their names and of their values."""
    named = layer.GetAttributeAtPath(names)
    if named is None or not named.default:
        return NO_TRACKS
    found = tuple(map(str, named.default))
    return Tracks(found, _read_samples(layer, values, (len(found),)))


def _read_samples(layer: Sdf.Layer, path: str, shape: tuple[int, ...]) -> FloatArray:
    """Return an attribute's time samples in their order, ``(n, *shape)``."""
    times = layer.ListTimeSamplesForPath(path)
    values = [np.array(layer.QueryTimeSample(path, time)) for time in times]
    if not values or any(value.shape != shape for value in values):
        found = sorted({value.shape for value in values})
        raise CharacterError(f"{path}: expected time samples of shape {shape}, got {found}")
    return np.array(values, dtype=np.float64)


def _define_skeleton(stage: Usd.Stage, path: str, skeleton: Skeleton) -> UsdSkel.Skeleton:
    rest = np.tile(np.eye(4), (len(skeleton), 1, 1))
    rest[:, :3, :3] = matrix_from_quaternion(skeleton.rest_rotation_xyzw)
    rest[:, :3, 3] = skeleton.rest_translation_m
    frame = StageFrame.of(stage)
    prim = UsdSkel.Skeleton.Define(stage, path)
    prim.CreateJointsAttr(joint_paths(skeleton))
    prim.CreateJointNamesAttr(list(skeleton.joints))
    prim.CreateBindTransformsAttr(_row_matrices(frame.transforms(skeleton.world_from_bind)))
    prim.CreateRestTransformsAttr(_row_matrices(frame.transforms(rest)))
    prim.GetPrim().SetCustomDataByKey(_ROLES, Vt.StringArray(list(skeleton.roles)))
    return prim


def _row_matrices(matrices: FloatArray) -> Vt.Matrix4dArray:
    """Return matrices that act on column vectors as USD's, which act on rows."""
    transposed = np.ascontiguousarray(np.swapaxes(matrices, -1, -2))
    return Vt.Matrix4dArray.FromNumpy(transposed)


def _rotation_xyzw(matrix: Gf.Matrix4d) -> list[float]:
    """Return a rigid transform's rotation; by USD, since SciPy's takes a while to load."""
    quaternion = matrix.ExtractRotationQuat()
    return [*quaternion.GetImaginary(), quaternion.GetReal()]


def _read_skeleton(prim: UsdSkel.Skeleton) -> Skeleton:
    joints = prim.GetJointsAttr().Get()
    roles = prim.GetPrim().GetCustomDataByKey(_ROLES)
    names = prim.GetJointNamesAttr().Get()
    bind, rest = (
        np.swapaxes(np.array(attribute.Get(), dtype=np.float64).reshape(-1, 4, 4), -1, -2)
        for attribute in (prim.GetBindTransformsAttr(), prim.GetRestTransformsAttr())
    )
    if not joints or roles is None or not len(joints) == len(bind) == len(rest):
        raise CharacterError(
            f"{prim.GetPath()}: expected joints with {_ROLES}, bind and rest transforms"
        )
    return Skeleton(
        joints=tuple(names or (path.rsplit("/", 1)[-1] for path in joints)),
        parents=np.array(UsdSkel.Topology(joints).GetParentIndices()),
        rest_rotation_xyzw=np.array(
            [_rotation_xyzw(m) for m in prim.GetRestTransformsAttr().Get()]
        ),
        rest_translation_m=rest[:, :3, 3],
        world_from_bind=bind,
        roles=tuple(roles),
    )


def _define_mesh(
    stage: Usd.Stage, path: str, mesh: Mesh, color_rgb: tuple[float, float, float]
) -> UsdGeom.Mesh:
    prim = define_mesh(stage, path, mesh.points_m, mesh.triangles, color_rgb)
    binding = UsdSkel.BindingAPI.Apply(prim.GetPrim())
    indices = binding.CreateJointIndicesPrimvar(constant=False, elementSize=MAX_INFLUENCES)
    weights = binding.CreateJointWeightsPrimvar(constant=False, elementSize=MAX_INFLUENCES)
    indices.Set(Vt.IntArray.FromNumpy(mesh.joint_indices.ravel().astype(np.int32)))
    weights.Set(Vt.FloatArray.FromNumpy(mesh.joint_weights.ravel().astype(np.float32)))
    binding.CreateGeomBindTransformAttr(Gf.Matrix4d(1.0))
    if mesh.shapes:
        names = unique_identifiers(shape.name for shape in mesh.shapes)
        _define_shapes(stage, path, mesh, names)
        binding.CreateBlendShapesAttr([shape.name for shape in mesh.shapes])
        targets = [f"{path}/{name}" for name in names]
        binding.CreateBlendShapeTargetsRel().SetTargets(targets)
    return prim


def _define_shapes(stage: Usd.Stage, path: str, mesh: Mesh, names: Sequence[str]) -> None:
    """Define a BlendShape of each name below a mesh: offsets of points, and of their normals.

    As `set_samples` does, in the layer and inside one change block: through the stage each shape
    would pay for all that are there.
    """
    frame, target = StageFrame.of(stage), stage.GetEditTarget()
    parent = target.GetLayer().GetPrimAtPath(target.MapToSpecPath(Sdf.Path(path)))
    plain = vertex_normals(mesh.points_m, mesh.triangles)
    with Sdf.ChangeBlock():
        for name, shape in zip(names, mesh.shapes, strict=True):
            moves = np.zeros(len(mesh.points_m), dtype=bool)
            moves[shape.indices] = True
            formed = mesh.points_m.copy()
            formed[shape.indices] += shape.offsets_m
            near = mesh.triangles[moves[mesh.triangles].any(axis=1)]
            normals = (vertex_normals(formed, near) - plain)[shape.indices]
            prim = Sdf.PrimSpec(parent, name, Sdf.SpecifierDef, "BlendShape")
            vectors, whole = Sdf.ValueTypeNames.Vector3fArray, Sdf.ValueTypeNames.IntArray
            _set_uniform(prim, "offsets", vectors, _vectors(frame.points(shape.offsets_m)))
            _set_uniform(prim, "normalOffsets", vectors, _vectors(frame.directions(normals)))
            indices = Vt.IntArray.FromNumpy(shape.indices.astype(np.int32))
            _set_uniform(prim, "pointIndices", whole, indices)


def _vectors(values: FloatArray) -> Vt.Vec3fArray:
    return Vt.Vec3fArray.FromNumpy(np.ascontiguousarray(values, dtype=np.float32))


def _set_uniform(prim: Sdf.PrimSpec, name: str, kind: Sdf.ValueTypeName, value: Any) -> None:
    Sdf.AttributeSpec(prim, name, kind, Sdf.VariabilityUniform).default = value


def define_mesh(
    stage: Usd.Stage,
    path: str,
    points_m: FloatArray,
    triangles: NDArray[np.int64],
    color_rgb: tuple[float, float, float],
) -> UsdGeom.Mesh:
    """Define a triangle mesh of one colour, smooth by its normals, with its extent."""
    prim = UsdGeom.Mesh.Define(stage, path)
    frame = StageFrame.of(stage)
    points = frame.points(points_m).astype(np.float32)
    # No subdivision: the triangles are the surface, and the normals make it smooth.
    prim.CreateSubdivisionSchemeAttr(UsdGeom.Tokens.none)
    prim.CreatePointsAttr(Vt.Vec3fArray.FromNumpy(points))
    prim.CreateFaceVertexCountsAttr(Vt.IntArray(len(triangles), 3))
    prim.CreateFaceVertexIndicesAttr(Vt.IntArray.FromNumpy(triangles.ravel().astype(np.int32)))
    normals = frame.directions(vertex_normals(points_m, triangles)).astype(np.float32)
    prim.CreateNormalsAttr(Vt.Vec3fArray.FromNumpy(normals))
    prim.SetNormalsInterpolation(UsdGeom.Tokens.vertex)
    prim.CreateExtentAttr(Vt.Vec3fArray.FromNumpy(np.stack([points.min(0), points.max(0)])))
    prim.CreateDisplayColorPrimvar(UsdGeom.Tokens.constant).Set([Gf.Vec3f(*color_rgb)])
    return prim


def _read_mesh(prim: UsdGeom.Mesh) -> Mesh:
    binding = UsdSkel.BindingAPI(prim)
    values = [
        prim.GetPointsAttr().Get(),
        prim.GetFaceVertexIndicesAttr().Get(),
        binding.GetJointIndicesPrimvar().Get(),
        binding.GetJointWeightsPrimvar().Get(),
    ]
    if any(value is None for value in values):
        raise CharacterError(f"{prim.GetPath()}: expected points, faces, joint indices and weights")
    points, faces, indices, weights = (np.array(value) for value in values)
    color = prim.GetDisplayColorPrimvar().Get() or [Gf.Vec3f(0.8)]
    try:
        return Mesh(
            name=prim.GetPrim().GetName(),
            points_m=points,
            triangles=faces.reshape(-1, 3),
            joint_indices=indices.reshape(-1, MAX_INFLUENCES),
            joint_weights=weights.reshape(-1, MAX_INFLUENCES),
            color_rgb=(float(color[0][0]), float(color[0][1]), float(color[0][2])),
            shapes=_read_shapes(binding, len(points)),
        )
    except ValueError as error:
        raise CharacterError(f"{prim.GetPath()}: expected triangles of 4 influences") from error


def _read_shapes(binding: UsdSkel.BindingAPI, count: int) -> tuple[BlendShape, ...]:
    """Return the shapes that a mesh of so many points is bound to."""
    prim = binding.GetPrim()
    names = [str(name) for name in binding.GetBlendShapesAttr().Get() or ()]
    targets = binding.GetBlendShapeTargetsRel().GetTargets()
    if len(names) != len(targets):
        raise CharacterError(
            f"{prim.GetPath()}: expected {len(names)} blend shapes, got {len(targets)}"
        )
    shapes = []
    for name, target in zip(names, targets, strict=True):
        shape = UsdSkel.BlendShape.Get(prim.GetStage(), target)
        offsets = shape.GetOffsetsAttr().Get() if shape else None
        if offsets is None:
            raise CharacterError(f"{target}: expected a BlendShape with offsets, found none")
        indices = shape.GetPointIndicesAttr().Get()
        where = np.arange(count) if indices is None else np.array(indices, dtype=np.int64)
        shapes.append(BlendShape(name, where, np.array(offsets).reshape(-1, 3)))
    return tuple(shapes)
