"""A character as a rig: turns of its joints about a mean, the way of its hips, its shapes.

A joint's turn is the rotation vector that leads from its mean rotation to the one it has [1]_:
three numbers that vanish at the mean and add up for small turns. The ground root is none of them:
whoever plays the poses places it.

References
----------
.. [1] F. S. Grassia, "Practical Parameterization of Rotations Using the Exponential Map",
   Journal of Graphics Tools 3 (3), 1998.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from smd.character.character import Character
from smd.character.clip import Clip
from smd.character.kinematics import forward_kinematics
from smd.character.poses import Poses
from smd.character.rig import Controls
from smd.character.skinning import skin_points
from smd.character.tracks import Tracks
from smd.errors import CharacterError
from smd.geometry.arrays import FloatArray, IntArray
from smd.geometry.rotations import (
    IDENTITY_XYZW,
    inverse,
    multiply,
    quaternion_from_rotvec,
    rotvec_from_quaternion,
)

_AXES = "xyz"


class CharacterRig:
    """A character that is posed by numbers, about the mean of clips.

    Its controls are called ``<joint>.turn_x`` (radians, about the joint's own axes),
    ``<hips>.move_x`` (metres, from where they are at rest) and as the shapes are. They range over
    all that the clips do, and rest.

    Parameters
    ----------
    character
        Its joint 0 is the ground root; the first joint below that is called hips here.
    clips
        Of its skeleton, at least one.

    Raises
    ------
    CharacterError
        If there is no clip, one of another skeleton, or nothing below the ground root.
    """

    def __init__(self, character: Character, clips: Sequence[Clip]) -> None:
        skeleton = character.skeleton
        if not clips or any(clip.skeleton.joints != skeleton.joints for clip in clips):
            raise CharacterError("rig: expected at least one clip, all of the character's joints")
        if 0 not in skeleton.parents:
            raise CharacterError("rig: expected joints below the ground root")
        self.character = character
        self.hips = int(np.flatnonzero(skeleton.parents == 0)[0])
        self.mean_xyzw = _mean(np.concatenate([clip.rotation_xyzw for clip in clips]))
        done = [
            self.values(Poses(clip.rotation_xyzw, clip.translation_m), clip.tracks)
            for clip in clips
        ]
        resting = Poses(skeleton.rest_rotation_xyzw[None], skeleton.rest_translation_m[None])
        rest = self.values(resting, Tracks((), np.zeros((1, 0))))
        every = np.concatenate([rest, *done])
        turns = [f"{joint}.turn_{axis}" for joint in skeleton.joints[1:] for axis in _AXES]
        moves = [f"{skeleton.joints[self.hips]}.move_{axis}" for axis in _AXES]
        self._controls = Controls(
            (*turns, *moves, *character.shapes), rest[0], every.min(axis=0), every.max(axis=0)
        )
        self._triangles = _faces(character)

    @property
    def controls(self) -> Controls:
        """What poses it."""
        return self._controls

    @property
    def triangles(self) -> IntArray:
        """Faces ``(t, 3)`` of all its meshes' points."""
        return self._triangles

    def values(self, poses: Poses, tracks: Tracks) -> FloatArray:
        """Return poses and weights of the character as values of the controls ``(n, d)``."""
        turned = multiply(inverse(self.mean_xyzw), poses.rotation_xyzw)[:, 1:]
        turns = rotvec_from_quaternion(turned).reshape(len(turned), -1)
        moves = (
            poses.translation_m[:, self.hips]
            - self.character.skeleton.rest_translation_m[self.hips]
        )
        weights = tracks.over(len(turned)).of(self.character.shapes)
        return np.concatenate([turns, moves, weights], axis=-1)

    def posed(self, values: ArrayLike) -> tuple[Poses, Tracks]:
        """Return the character's poses and weights, its ground root at the origin."""
        given = self._controls.poses(values)
        skeleton = self.character.skeleton
        n, turning = len(given), 3 * (len(skeleton) - 1)
        turns = given[:, :turning].reshape(n, -1, 3)
        rotation = np.tile(IDENTITY_XYZW, (n, len(skeleton), 1))
        rotation[:, 1:] = multiply(self.mean_xyzw[1:], quaternion_from_rotvec(turns))
        translation = np.tile(skeleton.rest_translation_m, (n, 1, 1))
        translation[:, 0] = 0.0
        translation[:, self.hips] += given[:, turning : turning + 3]
        return Poses(rotation, translation), Tracks(self.character.shapes, given[:, turning + 3 :])

    def surface_m(self, poses: ArrayLike) -> FloatArray:
        """Return the points of its skin, mesh by mesh, as `ControlRig.surface_m` does."""
        posed, tracks = self.posed(poses)
        skeleton = self.character.skeleton
        world = forward_kinematics(skeleton, *posed)
        skins = [
            skin_points(mesh, skeleton, *world, tracks.of(shape.name for shape in mesh.shapes))
            for mesh in self.character.meshes
        ]
        return np.concatenate(skins, axis=1)


def _mean(rotation_xyzw: FloatArray) -> FloatArray:
    """Return the mean rotation of each joint ``(j, 4)`` over frames.

    It is the quaternion whose squared products with all others are greatest in sum [1]_: signs do
    not matter.

    References
    ----------
    .. [1] F. L. Markley et al., "Averaging Quaternions", Journal of Guidance, Control, and
       Dynamics 30 (4), 2007.
    """
    products = np.einsum("nja,njb->jab", rotation_xyzw, rotation_xyzw)
    _, vectors = np.linalg.eigh(products)
    return np.asarray(vectors[..., -1])


def _faces(character: Character) -> IntArray:
    """Return the faces of all meshes, their points one mesh after the other."""
    starts = np.cumsum([0, *(len(mesh.points_m) for mesh in character.meshes)])
    faces = [mesh.triangles + start for mesh, start in zip(character.meshes, starts, strict=False)]
    found = np.concatenate(faces)
    found.flags.writeable = False
    return found
