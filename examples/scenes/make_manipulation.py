#!/usr/bin/env python3
"""Writes the scenes of the manipulation examples: rotate_box.xml, flip_box.xml, assemble.xml.

    python3 examples/scenes/make_manipulation.py [--check]

One finger serves all three: a base that moves in a horizontal plane and three capsules on parallel
hinges, hanging down, with a ball at the end. Only the ball touches. --check writes nothing and fails if a file differs from what would be written.
"""

import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent

HEAD = """\
<!-- {comment}

     Made by make_manipulation.py. Each motor pulls its joint to a position: controls are coordinates
     to reach. Friction is the smooth law, and contacts never pull, so that an optimiser meets no
     kink. -->
<redmax model="{name}">
  <option integrator="BDF1" timestep="0.005" gravity="0 0 -9.81" unit="m-kg"/>
  <ground pos="0 0 0" normal="0 0 1"/>
  <default>
    <motor ctrl="position" implicit="true"/>
    <ground_contact law="document" friction="smooth" friction_width="0.02" adhesion="false"/>
    <general_primitive_contact friction="smooth" friction_width="0.02" adhesion="false"/>
  </default>
  <robot>
"""

FINGER = """\
    <link name="{p}base">
      <joint name="{p}base" type="planar" axis0="1 0 0" axis1="0 1 0" pos="{pos}"/>
      <body name="{p}base" type="sphere" radius="0.02" density="6000"/>
      <link name="{p}proximal">
        <joint name="{p}knuckle" type="revolute" axis="0 1 0"/>
        <body name="{p}proximal" type="capsule" radius="0.01" length="0.1" pos="0 0 -0.05"
              density="1200"/>
        <link name="{p}middle">
          <joint name="{p}middle_hinge" type="revolute" axis="0 1 0" pos="0 0 -0.1"/>
          <body name="{p}middle" type="capsule" radius="0.01" length="0.08" pos="0 0 -0.04"
                density="1200"/>
          <link name="{p}distal">
            <joint name="{p}distal_hinge" type="revolute" axis="0 1 0" pos="0 0 -0.08"/>
            <body name="{p}distal" type="capsule" radius="0.01" length="0.06" pos="0 0 -0.03"
                  density="1200"/>
            <link name="{p}tip">
              <joint name="{p}tip" type="fixed" pos="0 0 -0.06"/>
              <body name="{p}tip" type="sphere" radius="0.012" density="1200"/>
            </link>
          </link>
        </link>
      </link>
    </link>
"""

BOX = """\
    <link name="{name}">
      <joint name="{name}" type="free3d-euler" pos="{pos}"/>
      <body name="{name}" type="cuboid" size="0.1 0.1 0.1" density="200"
            general_contact_resolution="{points}"/>
    </link>
"""

MOTORS = """\
    <motor joint="{p}base" P="300" D="15"/>
    <motor joint="{p}knuckle" P="4" D="0.1"/>
    <motor joint="{p}middle_hinge" P="3" D="0.07"/>
    <motor joint="{p}distal_hinge" P="2" D="0.04"/>
"""

GROUND = """\
    <ground_contact name="{box}-ground" body="{box}" kn="2000" kt="50" mu="{mu}" damping="1000"/>
"""

TOUCH = """\
    <general_primitive_contact name="{name}" general_body="{general}" primitive_body="{primitive}"
                               kn="{kn}" kt="50" mu="0.6" damping="100"/>
"""

TIP = """\
    <endeffector name="{p}tip" joint="{p}tip" radius="0.012"/>
"""


def scene(name, comment, fingers, boxes, ground_mu, touches, points="2 2 2"):
    text = HEAD.format(name=name, comment=comment)
    text += "".join(FINGER.format(p=p, pos=pos) for p, pos in fingers)
    text += "".join(BOX.format(name=box, pos=pos, points=points) for box, pos in boxes)
    text += "  </robot>\n  <actuator>\n"
    text += "".join(MOTORS.format(p=p) for p, _ in fingers)
    text += "  </actuator>\n  <contact>\n"
    text += "".join(GROUND.format(box=box, mu=ground_mu) for box, _ in boxes)
    text += "".join(TOUCH.format(name=f"{a}-{b}", general=a, primitive=b, kn=kn)
                    for a, b, kn in touches)
    text += "  </contact>\n  <variable>\n"
    text += "".join(TIP.format(p=p) for p, _ in fingers)
    return text + "  </variable>\n</redmax>\n"


# A box of 0.2 kg rests 0.2 · 9.81 / (4 · 2000) m deep in the ground.
REST = 0.05 - 0.2 * 9.81 / 8000.0

SCENES = {
    "rotate_box.xml": scene(
        "rotate_box", "A finger beside a box of 200 g on the ground, to turn it about the vertical.",
        [("", "0.035 -0.075 0.28")], [("box", f"0 0 {REST}")], 0.4, [("tip", "box", 2000)]),
    "flip_box.xml": scene(
        "flip_box", "A finger beside a box of 200 g on rough ground, to flip it over its edge.",
        [("", "0 -0.08 0.28")], [("box", f"0 0 {REST}")], 1.0, [("tip", "box", 2000)]),
    "assemble.xml": scene(
        "assemble", "Two fingers beside two boxes on the ground, to bring these together.",
        [("left_", "-0.225 0 0.28"), ("right_", "0.225 0 0.28")],
        [("left", f"-0.15 0 {REST}"), ("right", f"0.15 0 {REST}")], 0.4,
        [("left_tip", "left", 2000), ("right_tip", "right", 2000), ("left", "right", 1000),
         ("right", "left", 1000)]),
}


def main():
    check = "--check" in sys.argv[1:]
    stale = []
    for name, text in SCENES.items():
        path = HERE / name
        if check:
            if not path.exists() or path.read_text(encoding="utf-8") != text:
                stale.append(name)
        else:
            path.write_text(text, encoding="utf-8")
    if stale:
        sys.exit(f"not what make_manipulation.py writes: {', '.join(stale)}")


if __name__ == "__main__":
    main()
