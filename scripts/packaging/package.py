# Spack recipe of petsam, for Spack 1.0 and later (before it, leave out the first import).
#
#   spack repo create ~/petsam-repo petsam_local
#   mkdir -p ~/petsam-repo/spack_repo/petsam_local/packages/petsam
#   cp scripts/packaging/package.py ~/petsam-repo/spack_repo/petsam_local/packages/petsam/
#   spack repo add ~/petsam-repo/spack_repo/petsam_local
#   spack dev-build petsam@main          in a clone; or set `git` below, then spack install petsam
#
# Its requirements are those of the Makefile and of scripts/requirements.txt. README.md: how far it was tried.

from spack.package import *
from spack_repo.builtin.build_systems.makefile import MakefilePackage


class Petsam(MakefilePackage):
    """Partial-slip contact of elastic bodies by the semi-analytical method: six loads by force or displacement,
    Coulomb friction, load histories, wear, stresses, any number of MPI ranks, results in HDF5."""

    git = "file:///path/to/your/clone/of/petsam"

    license("BSD-2-Clause", checked_by="petsam")

    version("main", branch="main")
    version("1.0.0", tag="v1.0.0")

    variant("scripts", default=True, description="Python libraries of petsam-plot and the other scripts")

    depends_on("c", type="build")
    depends_on("gmake", type="build")
    depends_on("pkgconfig", type="build")
    depends_on("python@3.9:", type="build")  # man pages and completions
    depends_on("mpi")
    depends_on("petsc@3.18: +mpi+double~complex")
    depends_on("fftw@3.3: +mpi precision=double")
    depends_on("hdf5@1.10: +mpi+hl")
    depends_on("cmocka", type="test")

    with when("+scripts"):
        depends_on("python@3.9:", type=("build", "run"))
        depends_on("py-h5py@3:", type="run")
        depends_on("py-matplotlib@3.6:", type="run")
        depends_on("py-numpy@1.20:", type="run")
        depends_on("py-pyyaml@5.4:", type="run")
        depends_on("py-scipy@1.8:", type="run")

    def _words(self):
        # the compiler wrapper adds the target's flags
        return ["CC=" + self.spec["mpi"].mpicc, "OPT=-O3"]

    @property
    def build_targets(self):
        return self._words() + ["all"]

    @property
    def install_targets(self):
        return self._words() + ["prefix=" + self.prefix, "install"]

    def test_version(self):
        """The installed program prints its version."""
        petsam = which(self.prefix.bin.petsam)
        out = petsam("--version", output=str.split, error=str.split)
        assert "petsam" in out
