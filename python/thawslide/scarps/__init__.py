"""Release of a failure surface below a DEM: planes, an ellipsoid, or a sloping local base level."""

from thawslide.scarps.release import Release
from thawslide.scarps.surfaces import Ellipsoid, Plane, Slbl

__all__ = ["Ellipsoid", "Plane", "Release", "Slbl"]
