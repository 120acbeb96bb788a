"""All attributes that MuJoCo reads: each changes the scene or its report, or is listed as one that need not.

A new version of MuJoCo with new attributes fails here: they are to be put in one of the lists.
"""

import re
import xml.etree.ElementTree as ET
from functools import cache

import mujoco
import numpy as np

import carom

BASE = """<mujoco><compiler/><option><flag/></option>
<asset><mesh name="m" vertex="0 0 0 1 0 0 0 2 0 0 0 .5"/></asset>
<worldbody><geom name="floor" type="plane" size="1 1 .1"/><site name="p"/><site name="q" pos="0 0 1"/>
<body name="a" pos="0 0 2">
 <joint name="j" axis="0 1 0" pos="0 0 .1" range="-10 30" stiffness="1" damping=".1" frictionloss=".1"/>
 <geom name="g" type="box" size=".1 .2 .3" pos=".5 0 0"/><geom size=".05" pos="0 0 .5"/>
 <body name="b" pos="2 0 0"><inertial mass="1" pos="0 0 .1" diaginertia=".1 .12 .15"/>
 <joint name="k"/><geom size=".1"/><geom name="t" type="mesh" mesh="m" pos="0 0 3"/></body></body>
<body name="c" pos="0 9 3"><freejoint/><geom name="s" size=".1"/></body>
<body name="e" pos="9 9 9"><joint name="l"/><geom size=".1"/></body>
<body name="d" pos="0 20 3"><freejoint/><geom size=".1"/></body>
</worldbody>
<contact><pair geom1="g" geom2="s" friction=".7 .7"/><exclude body1="a" body2="d"/></contact>
<equality><connect body1="a" body2="c" anchor=".1 0 0"/><weld body1="c" body2="d"/>
<joint joint1="j" joint2="k" polycoef="0 1 0 0 0"/></equality>
<custom><numeric name="restitution" data=".5"/></custom></mujoco>"""
TURNS = {
    "axisangle": "0 0 1 20",
    "euler": "0 0 20",
    "quat": "1 0 0 .5",
    "xyaxes": "0 1 0 0 0 1",
    "zaxis": "1 0 1",
}
#: element, attribute: a value that changes the scene or its report; other attributes after it, None removes one
CHANGES = {
    "compiler": {
        "angle": "radian",
        "balanceinertia": "true inertial:diaginertia=.1_.1_.3",
        "boundinertia": "1",
        "boundmass": "2",
        "eulerseq": "ZYX body:euler=10_20_30",
        "inertiafromgeom": "true",
        "inertiagrouprange": "0 2 geom:group=3",
        "settotalmass": "9",
    },
    "option": {"density": "1", "gravity": "0 0 1", "viscosity": "1", "wind": "1 0 0"},
    "flag": dict.fromkeys(
        (
            "constraint",
            "contact",
            "damper",
            "equality",
            "frictionloss",
            "gravity",
            "limit",
            "spring",
        ),
        "disable",
    )
    | {"override": "enable", "filterparent": "disable"},
    "mesh": {
        "inertia": "shell",
        "maxhullvert": "5 mesh:vertex=0_0_0_1_0_0_0_2_0_0_0_1_1_1_1_-1_0_1_-1_-1_-1",
        "refpos": "1 0 0",
        "refquat": "1 0 0 1",
        "scale": "1 1 2",
        "vertex": "0 0 0 1 0 0 0 3 0 0 0 .5",
        "builtin": "sphere mesh:vertex= mesh:params=2",
        "params": "1 mesh:vertex= mesh:builtin=sphere",
    },
    "body": {
        **TURNS,
        "pos": "1 0 2",
        "gravcomp": ".5",
        "mocap": "true eqjoint:DELETE= joint:DELETE=",
    },
    "inertial": {
        **TURNS,
        "diaginertia": ".1 .1 .15",
        "fullinertia": ".1 .1 .1 0 0 .01 inertial:diaginertia=",
        "mass": "2",
        "pos": "0 0 .2",
    },
    "joint": {
        "armature": ".1",
        "axis": "1 0 0",
        "damping": ".2",
        "frictionloss": ".2",
        "limited": "false",
        "margin": ".1",
        "pos": "0 0 .2",
        "range": "-5 5",
        "ref": "5",
        "springdamper": "1 1",
        "springref": "5",
        "springyield": "1",
        "stiffness": "2",
        "type": "slide",
    },
    "geom": {
        **TURNS,
        "adhesion": "1",
        "conaffinity": "2 geom:contype=0",
        "condim": "6 pair:DELETE=",
        "contype": "2 geom:conaffinity=0",
        "density": "2",
        "fluidcoef": "1 1 1 1 1 geom:fluidshape=ellipsoid",
        "fluidshape": "ellipsoid",
        "friction": "3",
        "fromto": "0 0 0 1 0 0 geom:pos= geom:type=capsule",
        "gap": ".1",
        "margin": ".1",
        "mass": "3",
        "mesh": "m geom:type=mesh",
        "pos": "1 0 0",
        "priority": "2 geom:friction=.1",
        "shellinertia": "true",
        "size": ".1 .2 .4",
        "surfacevel": "1 0 0 0 0 0",
        "type": "ellipsoid",
        "fitscale": "2 geom:mesh=m geom:size=",
    },
    "pair": {
        "adhesion": "1",
        "condim": "6",
        "friction": "3 3",
        "gap": ".1",
        "margin": ".1",
        "geom1": "floor",
        "geom2": "t",
    },
    "exclude": {"body1": "b", "body2": "c pair:DELETE="},
    "connect": {
        "active": "false",
        "anchor": ".2 0 0",
        "body1": "d",
        "body2": "d",
        "site1": "p connect:body1= connect:body2= connect:anchor= connect:site2=q",
        "site2": "q connect:body1= connect:body2= connect:anchor= connect:site1=p",
    },
    "weld": {
        "active": "false",
        "anchor": ".2 0 0",
        "body1": "b",
        "body2": "b",
        "relpose": "1 0 0 1 0 0 0",
        "site1": "p weld:body1= weld:body2= weld:site2=q",
        "site2": "q weld:body1= weld:body2= weld:site1=p",
    },
    "eqjoint": {
        "active": "false",
        "joint1": "k eqjoint:joint2=j",
        "joint2": "l",
        "polycoef": "0 2 0 0 0",
    },
    "numeric": {"data": ".2", "name": "other"},
}
RESOLVED = "name class childclass file content_type"  # names and files, which MuJoCo resolves as it compiles
#: what changes no motion of rigid bodies: appearance, numbers of MuJoCo's own solver, its files,
#: softness (which one entry of each report names), and what acts only by an actuator
NOTHING = {
    "mujoco": "model",
    "compiler": (
        "alignfree assetdir autolimits conflict coordinate discardvisual fitaabb fusestatic "
        "meshdir passthrough savecanonical savecompiled saveinertial strippath texturedir "
        "usethread"
    ),
    "option": (
        "actuatorgroupdisable ccd_iterations ccd_tolerance cone impratio integrator iterations "
        "jacobian ls_iterations ls_tolerance magnetic noslip_iterations noslip_tolerance "
        "o_friction o_margin o_solimp o_solref sdf_initpoints sdf_iterations sleep_tolerance "
        "solver timestep tolerance"
    ),
    "flag": (
        "actuation autoreset clampctrl diagexact energy eulerdamp fwdinv invdiscrete ipc island "
        "midphase multiccd nativeccd refsafe sensor sleep speculative warmstart"
    ),
    "mesh": "face material normal smoothnormal texcoord",
    "body": "fuse simple sleep user",
    "joint": (
        "actuatorfrclimited actuatorfrcrange actuatorgravcomp group solimpfriction solimplimit "
        "solreffriction solreflimit user"
    ),
    "freejoint": "align group",
    "geom": "castshadow group hfield material rgba solimp solmix solref user",
    "pair": "solimp solref solreffriction",
    "connect": "solimp solref",
    "weld": "solimp solref torquescale",
    "eqjoint": "solimp solref",
    "numeric": "size",
    "key": "act ctrl mpos mquat plastic qpos qvel time",
}
#: elements with all that they contain: only visible, or MuJoCo's own, or composed from others by MuJoCo
UNSEEN = "lengthrange size statistic visual default texture material site camera light model attach text tuple"
#: elements that are reported as a whole (`WHOLE` has one of each kind)
REPORTED = "extension plugin hfield skin flexcomp deformable tendon flex flexstrain actuator sensor"
WHOLE = {
    "tendon": '<tendon><spatial name="x"><site site="p"/><site site="q"/></spatial></tendon>',
    "actuator": '<actuator><general name="x" joint="j" dyntype="filter" dynprm=".1"/></actuator>',
    "sensor": '<sensor><rangefinder name="x" site="p"/></sensor>',
    "geom": '<asset><hfield name="h" nrow="2" ncol="2" size="1 1 1 1"/></asset><worldbody>'
    '<geom name="x" type="hfield" hfield="h" pos="0 0 -9"/></worldbody>',
    "deformable": '<worldbody><flexcomp name="x" type="grid" count="2 2 1" spacing=".1 .1 .1" '
    'radius=".01" dim="2" pos="0 0 50"/></worldbody>',
}


def schema():
    """All pairs of an element, by its name and that of its parent, and an attribute."""
    found, path = [], []
    for line in mujoco.mj_printSchema(False, True).splitlines():
        head = re.match(r"( *)([()\w]+) +\((?:[*?!R])\)(.*)", line)
        if head:
            depth, name = len(head[1]) // 3, head[2].replace("(world)", "")
            path = [
                *path[:depth],
                "eqjoint" if path[depth - 1 : depth] == ["equality"] and name == "joint" else name,
            ]
        words = (head[3] if head else line).split()
        if not {*path} & {*UNSEEN.split(), *REPORTED.split()}:
            found += [(path[-1], word) for word in words]
    return sorted(set(found))


def found(root, element):
    if element == "body":
        return root.find("worldbody/body")
    if element == "geom":
        return root.find(".//geom[@name='g']")
    return root.find(
        "equality/joint"
        if element == "eqjoint"
        else f".//{element}"
        if element != "joint"
        else ".//body/joint"
    )


def changed(element, attribute, value):
    """The model with an attribute of an element; ``element:attribute=value`` in `value` are others."""
    root = ET.fromstring(BASE)
    first, *others = re.split(r" (?=\w+:\w+=)", value)
    found(root, element).set(attribute, first)
    for other in others:
        place, given = other.split(":", 1)
        name, text = given.split("=", 1)
        if name == "DELETE":
            for parent in root.iter():
                for child in [one for one in parent if one is found(root, place)]:
                    parent.remove(child)
        elif text:
            found(root, place).set(name, text.replace("_", " "))
        else:
            found(root, place).attrib.pop(name)
    return ET.tostring(root, encoding="unicode")


def plain(thing, seen):
    """All numbers and words in a thing, however deep, as text."""
    if isinstance(thing, np.ndarray):
        return (
            thing.round(12).tolist() if thing.dtype != object else [plain(x, seen) for x in thing]
        )
    if isinstance(thing, (str, int, float, type(None), np.generic)):
        return thing
    if id(thing) in seen:
        return getattr(thing, "name", "seen")
    seen[id(thing)] = thing
    if isinstance(thing, dict):
        return [(plain(k, seen), plain(v, seen)) for k, v in thing.items()]
    if isinstance(thing, (list, tuple)):
        return [plain(x, seen) for x in thing]
    if isinstance(thing, (set, frozenset)):
        return sorted(str(plain(x, seen)) for x in thing)
    return [type(thing).__name__, plain(getattr(thing, "__dict__", {}), seen)]


@cache
def seen(text):
    model = carom.load_model(text)
    return str(plain(model.scene, {})), str(model.report), str(model.restitution)


def test_each_attribute_is_in_one_list():
    listed = [(element, name) for element, values in CHANGES.items() for name in values]
    listed += [(element, name) for element, names in NOTHING.items() for name in names.split()]
    assert len(listed) == len(set(listed))
    there = {pair for pair in schema() if pair[1] not in RESOLVED.split()}
    there |= {("numeric", "name")}
    assert sorted(there - set(listed)) == []
    if mujoco.mj_versionString() == "4.0.0":
        assert sorted(set(listed) - there) == []


def test_an_attribute_is_honoured_or_reported():
    there, base = schema(), seen(BASE)  # this version of MuJoCo may not have all of them
    asked = [(e, a) for e, values in CHANGES.items() for a in values if (e, a) in there]
    assert len(asked) > 90
    assert [one for one in asked if seen(changed(*one, CHANGES[one[0]][one[1]])) == base] == []


URDF = """<robot name="r"><link name="base"/><link name="a"><inertial><origin xyz="0 0 .1" rpy="0 0 .1"/>
<mass value="1"/><inertia ixx=".1" iyy=".12" izz=".15" ixy=".001" ixz=".002" iyz=".003"/></inertial>
<collision><origin xyz="0 0 .2" rpy="0 .1 0"/><geometry><box size=".1 .2 .3"/></geometry></collision>
<collision><origin xyz="0 0 5"/><geometry><sphere radius=".4"/></geometry></collision>
<collision><origin xyz="0 0 6"/><geometry><cylinder radius=".31" length=".6"/></geometry></collision></link>
<link name="b"><inertial><mass value="2"/><inertia ixx=".1" iyy=".1" izz=".1" ixy="0" ixz="0" iyz="0"/>
</inertial></link>
<joint name="j" type="revolute"><parent link="base"/><child link="a"/><origin xyz="1 0 0" rpy=".2 0 0"/>
<axis xyz="1 2 0"/>
<limit lower="-1" upper="1.5" effort="1" velocity="1"/><dynamics damping=".7" friction=".8"/></joint>
<joint name="k" type="continuous"><parent link="a"/><child link="b"/><axis xyz="1 0 0"/>
<mimic joint="j" multiplier="2.5" offset=".25"/></joint></robot>"""


ATTRIBUTES = (
    'xyz="0 0 .1"',
    'rpy="0 0 .1"',
    'value="1"',
    'ixx=".1"',
    'iyy=".12"',
    'izz=".15"',
    'ixy=".001"',
    'ixz=".002"',
    'iyz=".003"',
    'xyz="0 0 .2"',
    'rpy="0 .1 0"',
    'size=".1 .2 .3"',
    'radius=".4"',
    'radius=".31"',
    'length=".6"',
    'xyz="1 0 0" rpy',
    'rpy=".2 0 0"',
    'xyz="1 2 0"',
    'lower="-1"',
    'upper="1.5"',
    'damping=".7"',
    'friction=".8"',
    'type="revolute"',
    'multiplier="2.5"',
    'offset=".25"',
)


def test_an_attribute_of_a_urdf_is_honoured_or_reported():
    """Those of <visual> and <material> are not read; effort and velocity limit motors, of which it has none."""
    mimic = "mimic" in str(carom.load_model(URDF).report)
    for attribute in ATTRIBUTES:
        assert URDF.count(attribute) == (2 if attribute == 'ixx=".1"' else 1), attribute
        if attribute == 'type="revolute"':
            other = URDF.replace(attribute, 'type="continuous"')
        else:
            other = URDF.replace(
                attribute, re.sub(r"[1-9]", lambda digit: str(int(digit[0]) % 9 + 1), attribute), 1
            )
        same = seen(other) == seen(URDF)
        assert not same or (mimic and attribute.startswith(("multiplier", "offset"))), attribute


def test_what_a_scene_does_not_have_is_reported():
    for element, text in WHOLE.items():
        model = carom.load_model(BASE.replace("</mujoco>", text + "</mujoco>"))
        assert model.report.of(element), element
