#!/usr/bin/env python3
"""Writes caped_figure.gltf: a skinned figure that stands, walks and runs, with a cape and bone colliders in its extras."""

import math

from make import UNSIGNED_SHORT, File, f32

# Lengths in m, angles in rad, forward is -z. A thigh, as a shin down to the ankle, and the height of the ankle.
LEG, ANKLE = 0.42, 0.08

# Speeds of the walk and the run, m/s, and how the hips of a run bob.
WALK, RUN, RUN_HEIGHT, BOB = 1.4, 4.2, 0.91, 0.03

# Keys of an animation.
KEYS = 24

# Particles along each edge of the cape, its width and length, and the joints of its collar.
COUNT, WIDTH, LENGTH, COLLAR = 25, 0.86, 1.12, 7

# The collar: its centre, half its width and its depth behind the neck, half its angle, and how far the cape stands off.
NECK, REACH, HALF_ANGLE, FLARE = (0.0, 1.475, 0.03), (0.19, 0.11), 0.75 * math.pi / 2, 0.12

# Distance that the cape keeps from the body: between two particles, cloth cuts as deep into a forearm.
MARGIN = 0.011

# Joints by their names: the parent, and the place at rest in the figure's frame. Sides are mirrored.
JOINTS = {"Hips": (None, (0.0, 0.95, 0.0)), "Chest": ("Hips", (0.0, 1.12, 0.0)), "Head": ("Chest", (0.0, 1.52, 0.0))}
for side, sign in (("Left", -1.0), ("Right", 1.0)):
    JOINTS[f"Arm{side}"] = ("Chest", (sign * 0.2, 1.41, 0.0))
    JOINTS[f"Forearm{side}"] = (f"Arm{side}", (sign * 0.22, 1.13, 0.0))
    JOINTS[f"Thigh{side}"] = ("Hips", (sign * 0.1, ANKLE + 2 * LEG, 0.0))
    JOINTS[f"Shin{side}"] = (f"Thigh{side}", (sign * 0.1, ANKLE + LEG, 0.0))


def parts():
    """The capsules of the body: joint, ends at rest, radius, and whether the cape may come near."""
    yield "Hips", (-0.06, 0.97, 0.0), (0.06, 0.97, 0.0), 0.12, True
    yield "Chest", (0.0, 1.05, 0.0), (0.0, 1.2, 0.0), 0.115, False
    yield "Chest", (-0.07, 1.29, 0.0), (0.07, 1.29, 0.0), 0.12, True
    yield "Chest", (-0.17, 1.41, 0.0), (0.17, 1.41, 0.0), 0.06, True
    yield "Chest", (0.0, 1.42, 0.0), (0.0, 1.55, -0.01), 0.05, False
    yield "Head", (0.0, 1.60, -0.02), (0.0, 1.67, -0.02), 0.09, False
    for side, x in (("Left", -1.0), ("Right", 1.0)):
        yield f"Arm{side}", (x * 0.2, 1.41, 0.0), (x * 0.22, 1.13, 0.0), 0.05, True
        yield f"Forearm{side}", (x * 0.22, 1.13, 0.0), (x * 0.22, 0.88, 0.0), 0.042, True
        yield f"Forearm{side}", (x * 0.22, 0.85, 0.0), (x * 0.22, 0.8, 0.0), 0.045, False
        yield f"Thigh{side}", (x * 0.1, ANKLE + 2 * LEG, 0.0), (x * 0.1, ANKLE + LEG, 0.0), 0.078, True
        yield f"Shin{side}", (x * 0.1, ANKLE + LEG, 0.0), (x * 0.1, ANKLE, 0.0), 0.055, True
        yield f"Shin{side}", (x * 0.1, ANKLE / 2, 0.03), (x * 0.1, ANKLE / 2, -0.15), 0.045, False


def minus(a, b):
    return tuple(a - b for a, b in zip(a, b))


def turn(axis, angle):
    """The quaternion of a turn about the x, y or z axis."""
    return tuple(math.sin(angle / 2) * (axis == name) for name in "xyz") + (math.cos(angle / 2),)


def times(a, b):
    """The product of two quaternions: first b, then a."""
    (ax, ay, az, aw), (bx, by, bz, bw) = a, b
    return (
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by - ax * bz + ay * bw + az * bx,
        aw * bz + ax * by - ay * bx + az * bw,
        aw * bw - ax * bx - ay * by - az * bz,
    )


def rotated(q, vector):
    x, y, z, w = times(times(q, vector + (0.0,)), (-q[0], -q[1], -q[2], q[3]))
    return x, y, z


def from_y_to(along):
    """The shortest turn from the y axis to a direction."""
    length = math.dist(along, (0.0, 0.0, 0.0))
    x, y, z = (part / length for part in along)
    if y < -0.999999:
        return 1.0, 0.0, 0.0, 0.0
    scale = math.sqrt(2.0 * (1.0 + y))
    return z / scale, 0.0, -x / scale, scale / 2.0


class Pose:
    """Turns of the joints at a phase of the gait; `walk` and `run` say how much of each it is."""

    def __init__(self, phase, walk, run):
        self.phase, self.walk, self.run = phase, walk, run

    def phase_of(self, joint):
        return self.phase + (math.pi if joint.endswith("Right") else 0.0)

    def thigh(self, joint):
        swing = 0.40 * self.walk + 0.35 * self.run
        return swing * math.sin(self.phase_of(joint)) + 0.06 * self.walk + 0.22 * self.run

    def knee(self, joint):
        swing = 0.75 * self.walk + 0.75 * self.run
        return 0.08 + 0.2 * self.run + swing * max(math.cos(self.phase_of(joint)), 0.0)

    def hips(self):
        """Height of the hips: one foot is on the ground in a walk, and a run leaps."""
        def leg(side):
            thigh = self.thigh(side)
            return LEG * (math.cos(thigh) + math.cos(thigh - self.knee(side)))

        above_thighs = JOINTS["Hips"][1][1] - JOINTS["ThighLeft"][1][1]
        on_ground = ANKLE + max(leg("Left"), leg("Right")) + above_thighs
        return on_ground + 0.85 * self.run * (RUN_HEIGHT - BOB * math.cos(2.0 * self.phase) - on_ground)

    def rotation(self, joint):
        twist = 0.10 * self.walk + 0.10 * self.run
        if joint == "Hips":
            return turn("y", 0.5 * twist * math.sin(self.phase))
        if joint == "Chest":
            lean = 0.02 * self.walk + 0.20 * self.run
            return times(turn("y", -1.5 * twist * math.sin(self.phase)), turn("x", -lean))
        if joint == "Head":
            return turn("x", 0.12 * self.run)
        if joint.startswith("Arm"):
            swing = 0.35 * self.walk + 0.40 * self.run
            angle = -swing * math.sin(self.phase_of(joint)) - 0.1 * self.run
            return times(turn("z", -0.08 if joint.endswith("Left") else 0.08), turn("x", angle))
        if joint.startswith("Forearm"):
            return turn("x", 0.15 + 0.15 * self.walk + 1.15 * self.run)
        return turn("x", self.thigh(joint) if joint.startswith("Thigh") else -self.knee(joint))


def animation(file, nodes, name, walk, run, period):
    """A whole turn of a gait in `period` seconds, which ends as it begins."""
    phases = [2.0 * math.pi * key / KEYS for key in range(KEYS + 1)]
    times_of_keys = file.add([(f32(period * key / KEYS),) for key in range(KEYS + 1)])
    file.accessors[times_of_keys].update(min=[0.0], max=[f32(period)])
    samplers, channels = [], []

    def animate(joint, path, values):
        channels.append({"sampler": len(samplers), "target": {"node": nodes[joint], "path": path}})
        samplers.append({"input": times_of_keys, "output": file.add(values), "interpolation": "LINEAR"})

    poses = [Pose(phase, walk, run) for phase in phases]
    for joint in JOINTS:
        animate(joint, "rotation", [pose.rotation(joint) for pose in poses])
    animate("Hips", "translation", [(0.0, f32(pose.hips()), 0.0) for pose in poses])
    return {"name": name, "samplers": samplers, "channels": channels}


def capsule(half, radius, rings=6, sides=16):
    """Positions, normals and triangles of a capsule along y."""
    angles = [math.pi / 2 * (1.0 - ring / rings) for ring in range(rings + 1)]
    rows = [(angle, half) for angle in angles] + [(-angle, -half) for angle in reversed(angles)]
    positions, normals, triangles = [], [], []
    for angle, middle in rows:
        for side in range(sides + 1):
            around = 2.0 * math.pi * side / sides
            normal = (math.cos(angle) * math.cos(around), math.sin(angle), math.cos(angle) * math.sin(around))
            normals.append(normal)
            positions.append((radius * normal[0], middle + radius * normal[1], radius * normal[2]))
    for row in range(len(rows) - 1):
        for side in range(sides):
            a, b = row * (sides + 1) + side, (row + 1) * (sides + 1) + side
            triangles += [a, a + 1, b, a + 1, b + 1, b]
    return positions, normals, triangles


def body(file):
    """The mesh of all parts. Near a joint, half of the skin follows the parent."""
    names = list(JOINTS)
    positions, normals, joints, weights, triangles = [], [], [], [], []
    for joint, begin, end, radius, _ in parts():
        parent, place = JOINTS[joint]
        rotation = from_y_to(minus(end, begin))
        middle = tuple((a + b) / 2 for a, b in zip(begin, end))
        shape = capsule(math.dist(begin, end) / 2, radius)
        first = len(positions)
        for position, normal in zip(*shape[:2]):
            at = tuple(f32(a + b) for a, b in zip(rotated(rotation, position), middle))
            own = f32(0.5 + 0.5 * min(math.dist(at, place) / 0.06, 1.0))
            positions.append(at)
            normals.append(rotated(rotation, normal))
            joints.append((names.index(joint), names.index(parent or joint), 0, 0))
            weights.append((own, 1.0 - own, 0.0, 0.0))
        triangles += [(first + corner,) for corner in shape[2]]
    attributes = {
        "POSITION": file.add(positions),
        "NORMAL": file.add(normals),
        "JOINTS_0": file.add(joints, UNSIGNED_SHORT),
        "WEIGHTS_0": file.add(weights),
    }
    return {"attributes": attributes, "indices": file.add(triangles, UNSIGNED_SHORT), "material": 0}


def column_major(place):
    """The inverse of the pose of a joint at a place, without a turn."""
    return [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, *(-at for at in place), 1.0]


def collar():
    """Names of the collar's joints, their places on the flat cloth, and their poses on the chest: z points away from it."""
    (across, behind), chest = REACH, JOINTS["Chest"][1]
    for joint in range(COLLAR):
        part = joint / (COLLAR - 1)
        angle = HALF_ANGLE * (2.0 * part - 1.0)
        at = (NECK[0] + across * math.sin(angle), NECK[1], NECK[2] + behind * math.cos(angle))
        outwards = math.atan2(behind * math.sin(angle), across * math.cos(angle))
        yield f"Collar{joint}", (WIDTH * part, 0.0, 0.0), minus(at, chest), times(turn("y", outwards), turn("x", -FLARE))


def cape():
    """The components of the cape: a grid of cloth whose vertices follow the two collar's joints beside them."""
    indices, weights = [], []
    for vertex in range(COUNT * COUNT):
        along = (vertex % COUNT) / (COUNT - 1) * (COLLAR - 1)
        left = min(int(along), COLLAR - 2)
        indices.append([left, left + 1, 0, 0])
        weights.append([round(1.0 - along + left, 6), round(along - left, 6), 0.0, 0.0])
    wool = {"area_density": 0.22, "bend_stiffness": 2e-4}
    return [
        {"ClothMesh": {"Grid": {"columns": COUNT, "rows": COUNT, "width": WIDTH, "height": LENGTH}}},
        {"ClothMaterial": wool},
        {"Attachment": {"target": "Chest", "vertices": {"Edge": "Top"}}},
        {"ClothSkin": {
            "joints": [name for name, *_ in collar()],
            "inverse_bind_poses": [column_major(place) for _, place, *_ in collar()],
            "joint_indices": indices,
            "joint_weights": weights,
        }},
        {"SkinLimits": {
            "max_distance": {"AlongV": {"top": 0.02, "bottom": 0.75}},
            "backstop_distance": {"Same": 0.04},
            "backstop_radius": {"Same": 0.4},
        }},
    ]


def figure():
    file = File()
    nodes = [{"name": "Figure", "children": []}]
    index = {"Figure": 0}

    def add(parent, node):
        nodes.append(node)
        nodes[index[parent]].setdefault("children", []).append(len(nodes) - 1)
        index[node["name"]] = len(nodes) - 1

    for joint, (parent, place) in JOINTS.items():
        from_parent = minus(place, JOINTS[parent][1]) if parent else place
        add(parent or "Figure", {"name": joint, "translation": from_parent})
    for name, _, place, rotation in collar():
        add("Chest", {"name": name, "translation": place, "rotation": rotation})
    for number, (joint, begin, end, radius, is_solid) in enumerate(parts()):
        if is_solid:
            half = math.dist(begin, end) / 2
            middle = tuple((a + b) / 2 for a, b in zip(begin, end))
            segment = {"a": [0.0, -half, 0.0], "b": [0.0, half, 0.0]}
            collider = {"shape": {"Capsule": {"segment": segment, "radius": radius}}, "margin": MARGIN, "features": False}
            add(joint, {
                "name": f"Capsule{number}",
                "translation": minus(middle, JOINTS[joint][1]),
                "rotation": from_y_to(minus(end, begin)),
                "extras": {"skein": [{"ClothCollider": collider}]},
            })
    add("Figure", {"name": "Body", "mesh": 0, "skin": 0})
    add("Figure", {"name": "Cape", "extras": {"skein": cape()}})
    bound = file.add([column_major(place) for _, place in JOINTS.values()])
    primitive = body(file)
    # A turn of a gait is two steps, which are longer at a higher speed.
    period = lambda speed: (0.9 + 0.45 * speed) / speed
    animations = [
        animation(file, index, "Stand", 0.0, 0.0, 1.0),
        animation(file, index, "Walk", 1.0, 0.0, period(WALK)),
        animation(file, index, "Run", 1.0, 1.0, period(RUN)),
    ]
    file.write("caped_figure.gltf", {
        "scenes": [{"nodes": [0]}],
        "nodes": nodes,
        "skins": [{"joints": [index[joint] for joint in JOINTS], "inverseBindMatrices": bound}],
        "meshes": [{"name": "Body", "primitives": [primitive]}],
        "animations": animations,
        "materials": [{
            "name": "Grey",
            "pbrMetallicRoughness": {
                "baseColorFactor": [0.095, 0.107, 0.133, 1.0],
                "metallicFactor": 0.0,
                "roughnessFactor": 0.7,
            },
        }],
    }, indent=None)


if __name__ == "__main__":
    figure()
