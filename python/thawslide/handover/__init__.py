"""Results of a run for other programs: terrain after the event, moving bottom of wave codes, hydrographs, assets."""

from thawslide.handover.assets import Asset, assets_hit
from thawslide.handover.dtopo import write_dtopo
from thawslide.handover.hydrographs import Hydrograph, hydrographs, write_hydrographs
from thawslide.handover.terrain import TerrainAfter, terrain_after

__all__ = [
    "Asset",
    "Hydrograph",
    "TerrainAfter",
    "assets_hit",
    "hydrographs",
    "terrain_after",
    "write_dtopo",
    "write_hydrographs",
]
