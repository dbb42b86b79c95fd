"""Drawings: a back read from the files of CAD, graphics and GIS, and a layout handed over to them."""
