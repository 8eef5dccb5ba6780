"""Mistakes that only building a scene shows: each changes a scene, given as a tree, and returns the words that the message must
have in one line. None hides another."""
import xml.etree.ElementTree as ElementTree


def child(parent, name):
    """The list of that name; made if it is not there."""
    for item in parent.findall("ParameterList"):
        if item.get("name") == name:
            return item
    return ElementTree.SubElement(parent, "ParameterList", name=name)


def put(parent, content):
    """Sets parameters and lists, given as by tests/support/scene_xml.py."""
    for name, value in content.items():
        if isinstance(value, dict):
            put(child(parent, name), value)
            continue
        for old in [item for item in parent.findall("Parameter") if item.get("name") == name]:
            parent.remove(old)
        kind = {str: "string", int: "int", float: "double", bool: "bool"}.get(type(value))
        if isinstance(value, tuple):
            kind = f"Array({ {int: 'int', str: 'string'}.get(type(value[0]), 'double') })"
            value = "{" + ", ".join(map(str, value)) + "}"
        text = str(value).lower() if kind == "bool" else str(value)
        ElementTree.SubElement(parent, "Parameter", name=name, type=kind, value=text)


def rigid(dim, **more):
    """A rigid ball that nothing is wrong with, far from all else."""
    return {"Type": "rigid body", "Geometry": {"Shape": "ball", "Radius": .05}, "Density": 700., "Position": (50.,) * dim, **more}


class Mistakes:
    """Damages a scene of a dimension; each method may be called several times."""

    def __init__(self, scene, dim):
        self.scene, self.dim, self.n = scene, dim, 0

    def new(self, place, kind, content):
        """Adds a list under a new name."""
        self.n += 1
        name = f"{kind} {self.n}"
        put(child(self.scene, place), {name: content})
        return name

    def solid(self, **more):
        return self.new("Solids", "Wrong", rigid(self.dim, **more))

    def body_with_two_masses(self):
        return [f'"{self.solid(Mass=1.)}" has both "Density" and "Mass"']

    def mesh_that_is_not_there(self):
        name = self.solid(Geometry={"Shape": "file", "File": f"none-{self.n}.obj"})
        return [f"none-{int(name.split()[1]) - 1}.obj", "cannot open"]

    def size_of_another_shape(self):
        return [f'"{self.solid(Geometry={"Shape": "ball", "Radius": .05, "Length": 1.})}/Geometry"', 'has no "Length"']

    def lock_twice(self):
        return [f'"{self.solid(Locked=("x", "y", "x"))}"', '"x" twice in "Locked"']

    def force_on_a_script(self):
        name = self.solid(Motion={"Type": "static"}, Force=(1.,) * self.dim)
        return [f'"{name}" follows a script']

    def body_of_a_thousand_domains(self):
        return [f'"{self.solid(Geometry={"Shape": "ball", "Radius": 1e8})}/Geometry"', "lengths are in metres"]

    def cloth_on_nobody(self):
        sheet = {"Shape": "sheet", "Size": (.2, 0., .2)[:self.dim], "Normal": "y", "Mesh Spacing": .1}
        region = {"Lower": (-90.,) * self.dim, "Upper": (90.,) * self.dim, "Solid": f"Nobody {self.n}"}
        self.new("Solids", "Sheet", {"Type": "cloth", "Geometry": sheet, "Young's Modulus": 1e4, "Thickness": .01,
                                     "Surface Density": 1., "Position": (60. + self.n,) * self.dim, "Attachments": {"Hem": region}})
        return [f'attached to "Nobody {self.n - 1}"']

    def joint(self, solids, **more):
        return self.new("Joints", "Bad joint", {"Type": "weld", "Solids": solids, "Point": (50.,) * self.dim, **more})

    def joint_of_nobody(self):
        return [f'"{self.joint(("space", "Stranger"))}" names the solid "Stranger"']

    def joint_with_itself(self):
        return [f'"{self.joint(("space", "space"))}" connects "space" with itself']

    def observer(self, content):
        return self.new("Observers", "Look", content)

    def gauge_of_a_point(self):
        return [f'"Observers/{self.observer({"Type": "gauge", "Points": (0.,) * (2 * self.dim)})}"', "are one"]

    def flow_through_a_box(self):
        name = self.observer({"Type": "flow", "Lower": (0.,) * self.dim, "Upper": (1.,) * self.dim})
        return [f'"Observers/{name}"', "no extent along 0 axes"]

    def half_a_point(self):
        return [f'"Observers/{self.observer({"Type": "points", "Points": (0.,) * (self.dim + 1)})}"', f"has {self.dim + 1} numbers"]

    def table_that_runs_have(self):
        put(child(self.scene, "Observers"), {"history": {"Type": "points", "Points": (0.,) * self.dim}})
        return ['"history" is the name of a table']

    def source_outside(self):
        put(child(child(self.scene, "Fluid"), "Sources"), {f"Jet {self.n}": {
            "Shape": "ball", "Center": (1e4,) * self.dim, "Radius": .1, "Velocity": (1.,) * self.dim}})
        self.n += 1
        return [f'"Jet {self.n - 1}"', "outside of the domain"]

    def cells_that_do_not_divide(self):
        put(child(self.scene, "Domain"), {"Cells": (7, 911, 7)[:self.dim]})
        return ["the cells must be as long along every axis"]

    def side_with_a_pressure(self):
        put(child(child(self.scene, "Domain"), "Sides"), {"x lower": {"Type": "slip wall", "Velocity": (0.,) * self.dim, "Pressure": 7.}})
        return ['"Domain/Sides/x lower"', '"Pressure" has no meaning']

    def end_before_the_start(self):
        put(child(self.scene, "Time"), {"Start": 1e3, "End": 1.})
        return ['"End" (1 s) must be later']

    def skin_of_nobody(self):
        put(child(self.scene, "Contact"), {"Type": "gauss seidel", "Skins": {"Ghost": {"Thickness": .01}}})
        return ['there is no solid "Ghost"']


# Mistakes that a fluid must be there for cannot be told where the fluid itself fails.
OF_THE_FLUID = ["source_outside", "cells_that_do_not_divide", "side_with_a_pressure"]
WANT_THE_FLUID = ["skin_of_nobody", "body_of_a_thousand_domains"]
ALL = [name for name in vars(Mistakes) if name not in ("new", "solid", "joint", "observer") and not name.startswith("_")]


def choose(rng, n):
    """Names of n mistakes that do not hide one another."""
    while True:
        names = rng.sample(ALL, n)  # bodies with one mistake are told together, as copies are
        of_fluid = any(name in OF_THE_FLUID for name in names)
        if of_fluid and any(name in WANT_THE_FLUID for name in names):
            continue
        # Outside of a domain that is none nothing can be.
        if not ("cells_that_do_not_divide" in names and "source_outside" in names):
            return names
