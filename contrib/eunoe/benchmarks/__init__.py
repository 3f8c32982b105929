"""Benchmarks of Eunoe beside LAMMPS and LIGGGHTS on the same bed of particles."""
