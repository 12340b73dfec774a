"""The robot's URDF, put together from those of airo-models: a UR5e that carries a Robotiq 2F-85."""

import xml.etree.ElementTree as ET
from pathlib import Path

from proc3s_tabletop.extra import extra

GRIPPER_PREFIX = "gripper_"
"""Both files name a link base_link: the links of the gripper get this prefix."""

LIGHT = ("5e-3", "1e-6")
"""Mass (kg) and moments of inertia (kg m2) of frames without any: PyBullet would give them 1 kg each."""


def write_robot(path: Path, visuals: bool = False) -> None:
    """Write the URDF of the arm with its gripper on tool0; meshes are named by absolute paths.

    Visual meshes are left out unless asked for: loading them takes longer than everything else.
    """
    parts = [*_parts("ur5e", ""), *_parts("robotiq_2f_85", GRIPPER_PREFIX)]
    _write(path, [*parts, _fixed("tool0", f"{GRIPPER_PREFIX}base_link")], visuals)


def write_hand(path: Path) -> None:
    """Write the URDF of the gripper alone; its base is where tool0 would be."""
    _write(path, _parts("robotiq_2f_85", GRIPPER_PREFIX), visuals=False)


def _write(path: Path, parts: list[ET.Element], visuals: bool) -> None:
    robot = ET.Element("robot", name="robot")
    robot.extend(parts)
    for link in robot.findall("link"):
        if not visuals:
            for visual in link.findall("visual"):
                link.remove(visual)
        if link.find("inertial") is None:
            link.append(_light())
    ET.ElementTree(robot).write(path, encoding="utf-8")


def _parts(model: str, prefix: str) -> list[ET.Element]:
    """The links and joints of a model of airo-models, its links renamed, its meshes found from anywhere."""
    with extra():
        from airo_models import get_urdf_path  # type: ignore[import-untyped, import-not-found, unused-ignore]

    path = Path(get_urdf_path(model))
    # Attributes of another simulator stand in a namespace that the file does not declare.
    root = ET.fromstring(path.read_text(encoding="utf-8").replace("drake:", ""))
    for mesh in root.iter("mesh"):
        mesh.set("filename", str((path.parent / mesh.attrib["filename"]).resolve()))
    for link in root.iter("link"):
        link.set("name", prefix + link.attrib["name"])
    for end in (*root.iter("parent"), *root.iter("child")):
        end.set("link", prefix + end.attrib["link"])
    for joint in root.iter("joint"):
        for mimic in joint.findall("mimic"):
            joint.remove(mimic)
    return [*root.findall("link"), *root.findall("joint")]


def _fixed(parent: str, child: str) -> ET.Element:
    joint = ET.Element("joint", name=f"{parent}_{child}", type="fixed")
    ET.SubElement(joint, "parent", link=parent)
    ET.SubElement(joint, "child", link=child)
    return joint


def _light() -> ET.Element:
    mass, moment = LIGHT
    inertial = ET.Element("inertial")
    ET.SubElement(inertial, "mass", value=mass)
    moments = {"ixx": moment, "iyy": moment, "izz": moment, "ixy": "0", "ixz": "0", "iyz": "0"}
    ET.SubElement(inertial, "inertia", moments)
    return inertial
