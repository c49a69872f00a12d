"""From a distance field to a mesh: polygonise, thin out, even out, mirror."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_matrix

from actions_library.authoring.body_field import Field
from smd.geometry.arrays import FloatArray, IntArray

EVENING_ROUNDS = 12
"""Rounds of edge flips, tangential smoothing and projection; the shape is settled after ten."""


def half_surface(field: Field, triangle_count: int) -> tuple[FloatArray, IntArray]:
    """Return the zero surface of a field whose first grid plane is a plane of symmetry.

    Parameters
    ----------
    field
        Distances, negative inside.
    triangle_count
        About how many triangles to keep; curved places keep more of them.

    Returns
    -------
    points_m : (p, 3)
        Those of the open rim lie in the plane exactly.
    triangles : (t, 3)
        Counter-clockwise seen from outside.
    """
    points, triangles = _polygonised(field)
    points, triangles = _thinned(points, triangles, triangle_count)
    plane_m = field.origin_m[0]
    rim = np.unique(_rim_edges(triangles))
    points[rim, 0] = plane_m
    for _ in range(EVENING_ROUNDS):
        triangles = _flipped(points, triangles)
        points = _relaxed(points, triangles, rim, field)
    return points, triangles


def mirrored(
    points: FloatArray, triangles: IntArray
) -> tuple[FloatArray, IntArray, NDArray[np.int64]]:
    """Return the closed surface of a half and its image in x, and each point's mirror point."""
    own = points[:, 0] > 0
    p = len(points)
    image = np.arange(p)
    image[own] = p + np.arange(int(own.sum()))
    reflected = points[own] * np.array([-1.0, 1.0, 1.0])
    both = np.concatenate([triangles, image[triangles][:, ::-1]])
    mirror = np.concatenate([image, np.flatnonzero(own)])
    return np.concatenate([points, reflected]), both, mirror


def _polygonised(field: Field) -> tuple[FloatArray, IntArray]:
    """Return the zero surface with one point per crossed grid edge."""
    from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
    from vtkmodules.vtkCommonDataModel import vtkImageData
    from vtkmodules.vtkFiltersCore import vtkFlyingEdges3D

    image = vtkImageData()
    image.SetDimensions(*field.values.shape)
    image.SetOrigin(*field.origin_m)
    image.SetSpacing(*(field.step_m,) * 3)
    # VTK's x runs fastest. Nodes exactly on the surface would give triangles without area.
    values = field.values.ravel(order="F")
    values = np.where(np.abs(values) < 1e-7, 1e-7, values)
    image.GetPointData().SetScalars(numpy_to_vtk(values))
    contour = vtkFlyingEdges3D()
    contour.SetInputData(image)
    contour.SetValue(0, 0.0)
    contour.ComputeNormalsOff()
    contour.ComputeGradientsOff()
    contour.ComputeScalarsOff()
    contour.Update()
    out = contour.GetOutput()
    points = vtk_to_numpy(out.GetPoints().GetData()).astype(np.float64)
    triangles = vtk_to_numpy(out.GetPolys().GetConnectivityArray()).reshape(-1, 3)
    return points, _outward(points, field, triangles.astype(np.int64))


def _outward(points: FloatArray, field: Field, triangles: IntArray) -> IntArray:
    """Return the triangles turned so that their normals follow the field's slope."""
    corners = points[triangles]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    along = np.einsum("tk,tk->t", normal, field.slope(corners.mean(axis=1)))
    return triangles if np.median(along) > 0 else triangles[:, ::-1].copy()


def _thinned(
    points: FloatArray, triangles: IntArray, triangle_count: int
) -> tuple[FloatArray, IntArray]:
    """Return the surface with fewer triangles, by least quadric error."""
    import pyvista as pv

    mesh = pv.PolyData.from_regular_faces(points, triangles)
    share = 1.0 - triangle_count / len(triangles)
    if share > 0:
        mesh = mesh.decimate(share, volume_preservation=True)
    return np.asarray(mesh.points, dtype=np.float64), np.asarray(mesh.regular_faces, np.int64)


def _rim_edges(triangles: IntArray) -> IntArray:
    """Return the directed edges that belong to one triangle only, ``(e, 2)``."""
    edges = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    _, first, count = np.unique(
        np.sort(edges, axis=1), axis=0, return_index=True, return_counts=True
    )
    return edges[first[count == 1]]


def _flipped(points: FloatArray, triangles: IntArray) -> IntArray:
    """Return the triangles after one sweep of Delaunay flips.

    An edge is flipped where the two angles facing it sum to more than half a turn, unless the
    two triangles fold against each other or the new edge exists already.
    """
    faces = [list(map(int, t)) for t in triangles]
    side: dict[tuple[int, int], int] = {}
    for f, (a, b, c) in enumerate(faces):
        side[a, b] = side[b, c] = side[c, a] = f
    for a, b in sorted(e for e in side if e[0] < e[1]):
        if (a, b) not in side or (b, a) not in side:
            continue
        left, right = side[a, b], side[b, a]
        c = next(v for v in faces[left] if v not in (a, b))
        d = next(v for v in faces[right] if v not in (a, b))
        if (c, d) in side or (d, c) in side or not _better_flipped(points, a, b, c, d):
            continue
        faces[left], faces[right] = [c, d, b], [d, c, a]
        del side[a, b], side[b, a]
        side[c, d], side[d, b], side[b, c] = left, left, left
        side[d, c], side[c, a], side[a, d] = right, right, right
    return np.array(faces, dtype=np.int64)


def _better_flipped(points: FloatArray, a: int, b: int, c: int, d: int) -> bool:
    """Return whether triangles (a, b, c), (b, a, d) are worse than (c, d, b), (d, c, a)."""
    pa, pb, pc, pd = points[a], points[b], points[c], points[d]
    if _angle(pa, pc, pb) + _angle(pa, pd, pb) <= np.pi + 1e-6:
        return False
    old = np.cross(pb - pa, pc - pa) + np.cross(pa - pb, pd - pb)
    new = (np.cross(pd - pc, pb - pc), np.cross(pc - pd, pa - pd))
    return all(float(n @ old) > 0.5 * np.linalg.norm(n) * np.linalg.norm(old) for n in new)


def _angle(p: FloatArray, apex: FloatArray, q: FloatArray) -> float:
    """Return the angle at ``apex`` between the ways to ``p`` and ``q``, in radians."""
    u, v = p - apex, q - apex
    return float(np.arctan2(np.linalg.norm(np.cross(u, v)), u @ v))


def _relaxed(
    points: FloatArray, triangles: IntArray, rim: NDArray[np.int64], field: Field
) -> FloatArray:
    """Return points moved along the surface to the middle of their neighbours, then back on it."""
    closed, both, _ = mirrored(points, triangles)
    middle = (adjacency(both, len(closed)) @ closed)[: len(points)]
    normal = field.slope(points)
    normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-9)
    step = middle - points
    step -= np.einsum("pk,pk->p", step, normal)[:, None] * normal
    moved = points + 0.5 * step
    moved[rim, 0] = points[rim, 0]
    for _ in range(2):
        slope = field.slope(moved)
        length2 = np.maximum((slope**2).sum(axis=1), 0.05)
        moved -= (field.sample(moved) / length2)[:, None] * slope
        moved[rim, 0] = points[rim, 0]
    return moved


def adjacency(triangles: IntArray, point_count: int) -> csr_matrix:
    """Return the matrix that takes values at points to the mean of their neighbours'."""
    edges = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    edges = np.concatenate([edges, edges[:, ::-1]])
    linked = csr_matrix(
        (np.ones(len(edges)), (edges[:, 0], edges[:, 1])), shape=(point_count, point_count)
    )
    linked.data[:] = 1.0
    degree = np.asarray(linked.sum(axis=1)).ravel()
    return csr_matrix(linked.multiply(1.0 / np.maximum(degree, 1.0)[:, None]))
