#!/usr/bin/python3
"""The judges of damaged files: what must be refused, what may be, and what says the same as before."""
import io
import unittest

import h5py
import numpy

import meaning
import mesh_files
from meaning import MAY, MUST, NOT
from program import with_checksum

SCENE = """<ParameterList name="Scene">
  <!-- A comment. -->
  <ParameterList name="Domain">
    <Parameter name="Cells" type="Array(int)" value="{8, [n]}"/>
  </ParameterList>
  <ParameterList name="Solids">
    <ParameterList name="Ball">
      <Parameter name="Density" type="double" value="700"/>
      <Parameter name="Position" type="Array(double)" value="{0.5, [max(1, 2)]}"/>
    </ParameterList>
  </ParameterList>
</ParameterList>
"""
# Text of the scene, what stands in its place, and the judgement.
SCENES = [("A comment.", "Another one.", "the same", NOT), ('value="700"', 'value="0.07e4"', "another value", MAY),
          ('value="700"', 'value="[700"', "a value that is none of its type", MUST), ('value="700"', 'value="[R]"', "another value", MAY),
          ('value="700"', 'value="1e999"', "a number without bounds", MUST), ('value="700"', 'value="nan"', "a value that is none of its type", MUST),
          ("{8, [n]}", "{8.5, 2}", "a value that is none of its type", MUST), ("{8, [n]}", "{8, 9", "a value that is none of its type", MUST),
          ('"double"', '"float"', "an unknown type", MUST), ('"double"', '"string"', "another type", MAY),
          ('"Density"', '"Densityx"', "a misspelt name", MUST), ('"Ball"', '"Globe"', "a name of another place", MAY),
          ('"Position"', '"Density"', "a name given twice", MUST), ('name="Density"', 'nam="Density"', "what is no parameter", MUST),
          ("</ParameterList>\n</ParameterList>", "</ParameterList>", "no XML", MUST), ("<ParameterList name=\"Domain\">", "text <ParameterList name=\"Domain\">", "what is no parameter", MUST),
          ('      <Parameter name="Density" type="double" value="700"/>\n', "", "less than before", MAY)]
# Kind of an icosahedron's file, text of it, what stands in its place, and the judgement.
MESHES = [("obj", "\nf ", "\n\nf ", "the same mesh, another text", MAY), ("obj", "f 1 ", "f 13 ", "a corner that is no vertex", MUST),
          ("off", "12 20 0", "12 19 0", "an open surface", MUST), ("stl", "endloop", "endlop", "the same mesh, another text", MAY),
          ("off", "0.0 ", "nan ", "no such mesh", MUST), ("obj", "0.0 ", "0.01 ", "other coordinates", MAY), ("off", "OFF", "OF", "no such mesh", MUST)]


def hdf5(**datasets):
    file = io.BytesIO()
    with h5py.File(file, "w") as opened:
        for name, values in datasets.items():
            opened[name] = values
        opened["places"].attrs["step"] = 3
    return with_checksum(file.getvalue())


class Judges(unittest.TestCase):
    def test_scenes(self):
        self.assertEqual(meaning.judge_parameters(SCENE.encode(), SCENE.encode()), meaning.SAME)
        for old, new, left, verdict in SCENES:
            with self.subTest(old=old, new=new):
                self.assertIn(old, SCENE)
                after = SCENE.replace(old, new, 1)
                self.assertEqual(meaning.judge_parameters(SCENE.encode(), after.encode()), (left, verdict))

    def test_meshes(self):
        for kind, old, new, left, verdict in MESHES:
            with self.subTest(kind, old=old):
                text = getattr(mesh_files, kind)(*mesh_files.icosahedron(0.3))
                self.assertIn(old, text)
                self.assertEqual(meaning.judge_mesh(kind, text.encode(), text.replace(old, new, 1).encode()), (left, verdict))
        text = mesh_files.gmsh(*mesh_files.filled(*mesh_files.icosahedron(0.3)), 3)
        self.assertEqual(meaning.judge_mesh("msh", text.encode(), text.replace(" 13\n", " 14\n", 1).encode())[1], MUST)

    def test_checkpoints(self):
        places = numpy.arange(4.0)
        whole = hdf5(places=places, files="a b")
        nan = numpy.array([0, 1, numpy.nan, 3])
        for after, verdict in [(hdf5(places=places, files="a b"), NOT), (hdf5(places=2 * places, files="a b"), MAY),
                               (hdf5(places=nan, files="a b"), MUST), (hdf5(places=places[:3], files="a b"), MUST),
                               (hdf5(places="text", files="a b"), MUST), (hdf5(places=places), MUST)]:
            self.assertEqual(meaning.judge_sealed_again(whole, after)[1], verdict)
            self.assertEqual(meaning.judge_system(whole, after)[1], verdict)
        flipped = bytes([whole[0] ^ 1]) + whole[1:]
        self.assertEqual(meaning.judge_bytes(whole, flipped)[1], MUST)
        self.assertEqual(meaning.judge_system(whole, flipped)[1], MUST)
        self.assertEqual(meaning.judge_system(whole, meaning.without_checksum(whole))[1], MAY)


if __name__ == "__main__":
    unittest.main()
