"""From a distance field to a mesh: polygonise, thin out, even out, mirror."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_matrix

from actions_library.authoring.body_field import Field
from smd.geometry.arrays import FloatArray, IntArray
from smd.geometry.rotations import normalized

EVENING_ROUNDS = 12
"""Rounds of edge flips, tangential smoothing and projection; the shape is settled after ten."""


BEND = 0.05
"""How much shorter than 1 the mean of the normals around a point is where it is half held."""

CREASE_RAD = 0.6
"""Triangles that meet at more than this angle meet at an edge of the shape."""

Warp = Callable[[FloatArray], FloatArray]


def half_surface(
    field: Field, triangle_count: int, magnified: Warp | None = None
) -> tuple[FloatArray, IntArray]:
    """Return the zero surface of a field whose first grid plane is a plane of symmetry.

    Parameters
    ----------
    field
        Distances, negative inside.
    triangle_count
        About how many triangles to keep; curved places keep more of them.
    magnified
        Moves points ``(p, 3)`` apart where more triangles than their size deserves are to stay.

    Returns
    -------
    points_m : (p, 3)
        Those of the open rim lie in the plane exactly.
    triangles : (t, 3)
        Counter-clockwise seen from outside.
    """
    points, triangles = _polygonised(field)
    points, triangles = _thinned(points, triangles, triangle_count, magnified)
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
    values = np.where(np.abs(values) < 1e-7, np.float32(1e-7), values)
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
    points: FloatArray, triangles: IntArray, triangle_count: int, magnified: Warp | None
) -> tuple[FloatArray, IntArray]:
    """Return the surface with fewer triangles, by least quadric error where it is magnified.

    The points kept are the nearest ones of the surface given, so that no way back from the
    magnified one is needed; evening out moves them on.
    """
    import pyvista as pv
    from scipy.spatial import KDTree

    seen = points if magnified is None else magnified(points)
    mesh = pv.PolyData.from_regular_faces(seen, triangles)
    mesh = mesh.decimate(max(0.0, 1.0 - triangle_count / len(triangles)), volume_preservation=True)
    kept = np.asarray(mesh.regular_faces, dtype=np.int64)
    rim = np.zeros(len(points), dtype=bool)
    rim[_rim_edges(triangles)] = True
    kept_rim = np.zeros(mesh.n_points, dtype=bool)
    kept_rim[_rim_edges(kept)] = True
    nearest = np.empty(mesh.n_points, dtype=np.int64)
    for old, new in ((rim, kept_rim), (~rim, ~kept_rim)):
        if new.any():
            found = KDTree(seen[old]).query(np.asarray(mesh.points)[new])[1]
            nearest[new] = np.flatnonzero(old)[found]
    return points[nearest], kept


def _half_edges(triangles: IntArray) -> tuple[IntArray, IntArray]:
    """Return each triangle's directed edges ``(3 t, 2)``, and a key that both directions share."""
    ends = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    return ends, _edge_keys(ends[:, 0], ends[:, 1], int(triangles.max()) + 1)


def _edge_keys(a: IntArray, b: IntArray, point_count: int) -> IntArray:
    """Return one number for each pair of points, whichever comes first."""
    return np.minimum(a, b) * point_count + np.maximum(a, b)


def _rim_edges(triangles: IntArray) -> IntArray:
    """Return the directed edges that belong to one triangle only, ``(e, 2)``."""
    ends, keys = _half_edges(triangles)
    _, first, count = np.unique(keys, return_index=True, return_counts=True)
    return ends[first[count == 1]]


def _flipped(points: FloatArray, triangles: IntArray) -> IntArray:
    """Return the triangles after one sweep of Delaunay flips.

    An edge is flipped where the two angles facing it sum to more than half a turn, unless its
    triangles meet at an edge of the shape, would fold, or the new edge exists already.
    """
    faces = triangles.copy()
    edges, left, right, c, d = _inner_edges(triangles)
    a, b = edges.T
    facing = _angle(points, a, c, b) + _angle(points, a, d, b)
    old = [_unit_normal(points, a, b, c), _unit_normal(points, b, a, d)]
    new = [_unit_normal(points, c, d, b), _unit_normal(points, d, c, a)]
    smooth = (old[0] * old[1]).sum(axis=1) > np.cos(CREASE_RAD)
    unfolded = (new[0] * new[1]).sum(axis=1) > np.cos(CREASE_RAD)
    made = _edge_keys(c, d, int(triangles.max()) + 1)
    fresh = ~np.isin(made, _half_edges(triangles)[1])
    wanted = np.flatnonzero((facing > np.pi + 1e-6) & smooth & unfolded & fresh)
    taken: set[int] = set()
    touched = np.zeros(len(faces), dtype=bool)
    for e in wanted[np.argsort(-facing[wanted], kind="stable")]:
        if touched[left[e]] or touched[right[e]] or int(made[e]) in taken:
            continue
        taken.add(int(made[e]))
        touched[[left[e], right[e]]] = True
        faces[left[e]] = c[e], d[e], b[e]
        faces[right[e]] = d[e], c[e], a[e]
    return faces


def _inner_edges(
    triangles: IntArray,
) -> tuple[IntArray, IntArray, IntArray, IntArray, IntArray]:
    """Return edges of two triangles: their ends, the triangles, the corners facing them.

    The left triangle runs from the edge's first end to its second, the right one back.
    """
    t = len(triangles)
    ends, keys = _half_edges(triangles)
    apex = np.concatenate([triangles[:, 2], triangles[:, 0], triangles[:, 1]])
    owner = np.tile(np.arange(t), 3)
    # Both halves of an edge follow each other, the one that runs upwards first.
    order = np.lexsort([ends[:, 0] > ends[:, 1], keys])
    pair = np.flatnonzero(np.diff(keys[order]) == 0)
    one, two = order[pair], order[pair + 1]
    return ends[one], owner[one], owner[two], apex[one], apex[two]


def _unit_normal(points: FloatArray, a: IntArray, b: IntArray, c: IntArray) -> FloatArray:
    """Return the unit normals of triangles with the given corners."""
    return normalized(np.cross(points[b] - points[a], points[c] - points[a]))


def _angle(points: FloatArray, p: IntArray, apex: IntArray, q: IntArray) -> FloatArray:
    """Return the angles at ``apex`` between the ways to ``p`` and ``q``, in radians."""
    u, v = points[p] - points[apex], points[q] - points[apex]
    return np.arctan2(np.linalg.norm(np.cross(u, v), axis=1), (u * v).sum(axis=1))


def _relaxed(
    points: FloatArray, triangles: IntArray, rim: NDArray[np.int64], field: Field
) -> FloatArray:
    """Return points moved along the surface to the middle of their neighbours, then back on it."""
    closed, both, mirror = mirrored(points, triangles)
    mean = adjacency(both, len(closed))
    normal = normalized(field.slope(points))
    step = (mean @ closed)[: len(points)] - points
    step -= np.einsum("pk,pk->p", step, normal)[:, None] * normal
    # On an edge of the shape neighbours' normals differ, and their mean is short: points stay
    # there, or hems and rims would fray.
    normals = np.concatenate([normal, normal[mirror[len(points) :]] * [-1.0, 1.0, 1.0]])
    bend = 1.0 - np.linalg.norm((mean @ normals)[: len(points)], axis=1, keepdims=True)
    moved = points + 0.5 * step / (1.0 + (bend / BEND) ** 2)
    moved[rim, 0] = points[rim, 0]
    for _ in range(2):
        slope = field.slope(moved)
        length2 = np.maximum((slope**2).sum(axis=1), 0.05)
        moved -= (field.sample(moved) / length2)[:, None] * slope
        moved[rim, 0] = points[rim, 0]
    return moved


def adjacency(triangles: IntArray, point_count: int) -> csr_matrix:
    """Return the matrix that takes values at points to the mean of their neighbours'."""
    edges = _half_edges(triangles)[0]
    edges = np.concatenate([edges, edges[:, ::-1]])
    linked = csr_matrix(
        (np.ones(len(edges)), (edges[:, 0], edges[:, 1])), shape=(point_count, point_count)
    )
    linked.data[:] = 1.0
    degree = np.asarray(linked.sum(axis=1)).ravel()
    return csr_matrix(linked.multiply(1.0 / np.maximum(degree, 1.0)[:, None]))
