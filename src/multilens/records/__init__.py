"""The nouns as plain data, records, lists, texts and numbers, as a file holds them, and back again.

A float is handed on as it is, so that what is read back is the same to the bit. Whatever reads checks every field; the name it
is given is the path of the key, and each refusal is a ValueError of one line that begins with it.
"""

from multilens.records.history import convergence_record, origin_record, read_convergence, read_origin
from multilens.records.layouts import certificate_record, layout_record, read_certificate, read_layout
from multilens.records.nouns import Record, named_record, noun_record, read_named, read_noun
from multilens.records.problems import lens_record, problem_record, read_lens, read_problem
from multilens.records.shapes import back_record, read_back, read_shape, shape_record

__all__ = [
    "Record",
    "back_record",
    "certificate_record",
    "convergence_record",
    "layout_record",
    "lens_record",
    "named_record",
    "noun_record",
    "origin_record",
    "problem_record",
    "read_back",
    "read_certificate",
    "read_convergence",
    "read_layout",
    "read_lens",
    "read_named",
    "read_noun",
    "read_origin",
    "read_problem",
    "read_shape",
    "shape_record",
]
