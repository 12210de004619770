"""The bodies of a mesh, with their contact surfaces: one, or the two of a pair, which share no nodes."""

from dataclasses import dataclass, replace

import numpy as np
from scipy import sparse
from scipy.sparse.csgraph import connected_components

from ...core.brief import brief
from ...core.decks import folded
from ...core.errors import Error
from . import images
from .mesh import Block, Mesh


@brief
@dataclass
class Part:
    """A body: the mesh of its elements with all nodes of the model, the faces of its contact surface, and its sign: 1
    for z >= 0, -1 for z <= 0."""

    mesh: Mesh
    contact: list
    sign: int = 1

    def moduli(self, patch):
        """(E, nu) of the material under the patch."""
        found = set()
        for group in self.contact:
            block = self.mesh.blocks[group.block]
            x = self.mesh.nodes[group.nodes].mean(axis=1)
            inside = np.all(np.abs(x[:, :2] - patch.center) <= patch.half, axis=1)
            chosen = group.elements[inside] if np.any(inside) else group.elements
            found |= set(zip(block.young[chosen].tolist(), block.poisson[chosen].tolist()))
        if len(found) > 1:
            raise Error("the contact surface has several materials under the patch: use a smaller --patch")
        return found.pop()

    def uniform(self):
        """True if the body has only one material."""
        return len({pair for b in self.mesh.blocks for pair in zip(b.young.tolist(), b.poisson.tolist())}) == 1

    def beyond(self, patch):
        """True if parts of the body lie on the other side of the plane of the patch."""
        z = self.sign * self.mesh.nodes[self.mesh.used(), 2]
        return bool(np.min(z) < -images.FLAT * patch.wide)


class Components:
    """The connected parts of a mesh: their number for each node, and the surfaces that lie on them."""

    def __init__(self, mesh):
        self.mesh = mesh
        rows = np.concatenate([np.repeat(block.nodes[:, 0], block.nodes.shape[1]) for block in mesh.blocks])
        columns = np.concatenate([block.nodes.ravel() for block in mesh.blocks])
        pattern = sparse.coo_matrix((np.ones(len(rows)), (rows, columns)), shape=2 * (len(mesh.nodes),))
        self.count, self.of_node = connected_components(pattern, directed=False)

    def of_surface(self, name):
        """Number of the component on which a surface of the deck lies."""
        groups = self.mesh.surface_faces(folded(name))
        found = {int(one) for group in groups for one in np.unique(self.of_node[group.nodes])}
        if not found:
            raise Error(f"surface {name} has no element faces: define it by TYPE=ELEMENT, by faces that the mesh has")
        if len(found) > 1:
            raise Error(f"surface {name} lies on {len(found)} separate bodies: divide it into one surface for each")
        return found.pop()

    def part(self, number):
        """The mesh of the elements of one component."""
        chosen = [(block, self.of_node[block.nodes[:, 0]] == number) for block in self.mesh.blocks]
        return replace(self.mesh, blocks=[_some(block, mask) for block, mask in chosen if np.any(mask)])

    def _groups(self, links):
        """Groups of the components that links (first, second) join."""
        ends = np.array(links, dtype=int).reshape(-1, 2).T
        pattern = sparse.coo_matrix((np.ones(ends.shape[1]), tuple(ends)), shape=2 * (self.count,))
        return connected_components(pattern, directed=False)[1]

    def need_held(self, supported, links):
        """Raises Error if no node of a component, or of those that are joined to it, is supported."""
        group = self._groups(links)[self.of_node]
        free = np.flatnonzero(~np.isin(group, group[supported]))
        if len(free):
            x = self.mesh.nodes[group == group[free[0]]].mean(axis=0)
            raise Error(
                f"the body about x = {x[0]:.3g}, y = {x[1]:.3g}, z = {x[2]:.3g} m of the frame floats, as nothing but "
                "the contact holds it: hold it by --fixed, or join it to the other body by --bolt"
            )

    def need_one(self, links):
        """Raises Error unless links join all components."""
        group = self._groups(links)[self.of_node]
        if np.any(group != group[0]):
            x, y = (self.mesh.nodes[mask].mean(axis=0) for mask in (group == group[0], group != group[0]))
            raise Error(
                "--free: the bodies about x = {:.3g}, y = {:.3g}, z = {:.3g} m and x = {:.3g}, y = {:.3g}, z = {:.3g} "
                "m of the frame float against each other, as no bolt joins them: join them by --bolt, or hold both by "
                "--fixed instead of --free".format(*x, *y)
            )

    def need_joined(self, first, second, links):
        """Raises Error if a part of the mesh is neither one of two components nor joined to one by links."""
        group = self._groups([*links, (first, second)])
        free = np.flatnonzero(group != group[first])
        if len(free):
            x = self.mesh.nodes[self.of_node == free[0]].mean(axis=0)
            raise Error(
                f"the mesh has {self.count} separate parts; the one about x = {x[0]:.3g}, y = {x[1]:.3g}, z = "
                f"{x[2]:.3g} m of the frame is joined to neither body: join it by --bolt, or remove it from the deck"
            )


def _some(block, mask):
    density = None if block.density is None else block.density[mask]
    return Block(block.kind, block.numbers[mask], block.nodes[mask], block.young[mask], block.poisson[mask], density)


def pair(components, contact, other, links):
    """Returns the Parts of body 2, with the surface `contact`, and of body 1, with `other`."""
    second, first = components.of_surface(contact), components.of_surface(other)
    if first == second:
        raise Error(
            f"surfaces {contact} of --contact and {other} of --pair are of one body: give both bodies nodes of their "
            "own, also at the contact"
        )
    components.need_joined(first, second, links)
    found = []
    for number, name, sign in ((second, contact, 1), (first, other, -1)):
        mesh = components.part(number)
        faces = mesh.surface_faces(folded(name))
        outward = sum(mesh.gauss(group, 2).area.sum(axis=(0, 1)) for group in faces)
        if sign * outward[2] > -0.9 * np.linalg.norm(outward):
            raise Error(f"surface {other} of --pair does not face surface {contact} of --contact: name one that does")
        found.append(Part(mesh, faces, sign))
    return found
