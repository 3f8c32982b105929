"""Predicts how a case would be shared out over many ranks, and what its steps would take.

Usage: contrib/tools predict-scaling output/my_run/spreading_00042.vtu [--ranks 64,128,...]
       contrib/tools predict-scaling --length-factor 0.5714 --depth 2e-3 --layers 20
           [--steps 75e6] [--latency 1.5e-6] [--bandwidth 12e9] [--copy 4e9]
           [--ranks-per-node 64] [--memory 200e9] [--traffic 1e3] [--cache 4e6] [--speeds 2e4:28.2e6,2e5:18.4e6,1e6:15.1e6] [--ghost 0.22] [--paired 0.6] [--search 8]
           [--interval 160]
           [--cell-weight 20] [--particle-weight 2000] [--reach 1e-4] [--skin 0.13] [--compare] [--json FILE]

The particles are those of a picture of a run, or of the paper's apparatus with W1 to W4 times the
length factor. The mesh is cut as the program cuts it, with the given weights of a cell and a
particle. doc/performance.md explains the columns and the costs.

--steps    number of steps of the run: adds core-hours
--reach    distance (m) within which a rank has a particle as a ghost, from the particle's centre to
           a mesh cell of that rank. Default: as in the program, each particle's radius, the largest
           radius, and the skin
--skin     as a share of the largest diameter, 0.13 in prm/spreading
--compare  instead shows what each piece (rank) of the picture really holds beside the prediction
           for that number of ranks
"""

from __future__ import annotations

import argparse
import json
from dataclasses import asdict, replace
from pathlib import Path

import numpy as np

from eunoe.launch import Failure, parser, rank_numbers
from eunoe.vtk_files import points_of_pieces

from . import apparatus, snapshot
from .cost import Costs, Prediction, predict
from .ghosts import Filling, reach_of
from .mesh import Mesh
from .partition import Partition, divide


def parse(words: list[str]) -> argparse.Namespace:
    costs = Costs()
    arguments = parser(__doc__)
    arguments.add_argument("picture", nargs="?", type=Path)
    arguments.add_argument("--length-factor", type=float)
    arguments.add_argument("--depth", type=float, default=2e-3)
    arguments.add_argument("--layers", type=int, default=20)
    arguments.add_argument("--ranks", default="1,2,4,8,16,32,64,128,256,512,1024,2048,4096")
    arguments.add_argument("--steps", type=float)
    for name in ("latency", "bandwidth", "copy", "memory", "traffic", "cache", "ghost", "paired", "search", "interval"):
        arguments.add_argument(f"--{name}", type=float, default=getattr(costs, name))
    arguments.add_argument("--ranks-per-node", type=int, default=costs.ranks_per_node)
    arguments.add_argument("--speeds", default=",".join(f"{n:g}:{s:g}" for n, s in costs.speeds))
    arguments.add_argument("--cell-weight", type=int, default=20)
    arguments.add_argument("--particle-weight", type=int, default=2000)
    arguments.add_argument("--reach", type=float)
    arguments.add_argument("--skin", type=float, default=0.13)
    arguments.add_argument("--compare", action="store_true")
    arguments.add_argument("--json", type=Path)
    options = arguments.parse_args(words)
    if (options.picture is None) == (options.length_factor is None):
        raise Failure("Name a picture (.vtu) of a run, or give --length-factor.")
    if options.compare and options.picture is None:
        raise Failure("--compare needs a picture of a run.")
    if options.reach is not None and not options.reach >= 0.:
        raise Failure(f"--reach {options.reach}: give a length in m, as in 1e-4.")
    return options


def costs_of(options: argparse.Namespace) -> Costs:
    try:
        speeds = tuple(sorted(tuple(float(v) for v in pair.split(":"))
                              for pair in options.speeds.split(",")))
        if any(len(pair) != 2 or min(pair) <= 0. for pair in speeds):
            raise ValueError
    except ValueError:
        raise Failure(f"--speeds {options.speeds}: give particles:speed pairs, as in "
                      "2e4:28.2e6,2e5:18.4e6,1e6:15.1e6.") from None
    return replace(Costs(), speeds=speeds, ghost=options.ghost, paired=options.paired,
                   search=options.search, interval=options.interval, latency=options.latency,
                   bandwidth=options.bandwidth, copy=options.copy, ranks_per_node=options.ranks_per_node,
                   memory=options.memory, traffic=options.traffic, cache=options.cache)


def row(p: Prediction, part: Partition, steps: float | None) -> str:
    slowest = ", ".join(f"{name} {100. * value / p.seconds:.0f} %" for name, value in
                        p.parts.items() if value > 0.005 * p.seconds)
    hours = f"{p.n_ranks * p.seconds * steps / 3600.:11.0f}" if steps else ""
    return (f"{p.n_ranks:6d} {part.owned.mean():11.0f} {100. * part.imbalance:9.1f} % "
            f"{part.ghost_fraction:7.2f} {part.neighbours.max():6d} {1e-3 * p.mean_bytes:9.1f} "
            f"{1e-3 * p.largest_bytes:9.1f} {1e6 * p.seconds:11.1f} {100. * p.efficiency:9.0f} % "
            f"{p.memory / 2**20:8.0f}{hours}  {slowest}")


def compare(picture: Path, mesh: Mesh, filling: Filling, options: argparse.Namespace) -> None:
    real = points_of_pieces(picture)
    part = divide(mesh, filling, mesh.curve(), len(real), options.cell_weight,
                  options.particle_weight)
    print("rank  owned  predicted  ghosts predicted")
    for rank, number in enumerate(real):
        print(f"{rank:4d} {number:6d} {part.owned[rank]:10d} {part.ghosts[rank]:17d}")


def filling_of(options: argparse.Namespace) -> tuple[Mesh, Filling]:
    """The mesh, and the particles in it."""
    if options.picture is not None:
        mesh, points, diameters = snapshot.read(options.picture, options.skin)
    else:
        place = apparatus.apparatus(options.length_factor, options.depth)
        mesh, points = apparatus.mesh_of(place, skin=options.skin), apparatus.powder(place, options.layers)
        diameters = apparatus.sizes(len(points))
    reach = reach_of(diameters, options.skin) if options.reach is None else options.reach
    filling = Filling(mesh, points, reach)
    occupied = np.count_nonzero(filling.counts)
    print(f"{len(points)} particles; lattice of {' x '.join(map(str, mesh.cells))} cells, in trees of "
          f"{2 ** mesh.refinement} cells a side; {occupied} lattice cells with particles, "
          f"{len(points) / occupied:.1f} in each")
    return mesh, filling


def head(with_hours: bool) -> str:
    """The two lines above the rows."""
    return (f"{'':6s} {'particles':>11s} {'':>11s} {'ghosts':>7s} {'most':>6s} {'kB a step':>9s} "
            f"{'':>9s} {'':>11s} {'':>11s} {'MiB of':>8s}" + (f"{'core-':>11s}" if with_hours else "") + "\n"
            f"{'ranks':>6s} {'a rank':>11s} {'imbalance':>11s} {'/ own':>7s} {'neigh.':>6s} "
            f"{'mean':>9s} {'most':>9s} {'us a step':>11s} {'efficiency':>11s} {'a rank':>8s}"
            + (f"{'hours':>11s}" if with_hours else "") + "  of the slowest rank's time")


def main(words: list[str]) -> int:
    options = parse(words)
    costs, ranks = costs_of(options), rank_numbers(options.ranks)
    mesh, filling = filling_of(options)
    if options.compare:
        compare(options.picture, mesh, filling, options)
        return 0
    curve = mesh.curve()
    print(head(bool(options.steps)))
    records = []
    for n in ranks:
        part = divide(mesh, filling, curve, n, options.cell_weight, options.particle_weight)
        prediction = predict(part, int(np.prod(mesh.trees)), costs)
        print(row(prediction, part, options.steps), flush=True)
        records.append({**asdict(prediction), "imbalance": part.imbalance,
                        "ghost_fraction": part.ghost_fraction,
                        "owned": part.owned.tolist(), "ghosts": part.ghosts.tolist()})
    if options.json:
        options.json.write_text(json.dumps({"costs": asdict(costs), "ranks": records}, indent=1)
                                + "\n", encoding="utf-8")
    return 0
