! A sphere on a plane on all ranks of an MPI program: pressed by 1000 N, pushed to and fro sideways by 60 N.
program contact
  use, intrinsic :: iso_c_binding
  use, intrinsic :: iso_fortran_env, only: error_unit
  use petsam
  use mpi, only: MPI_Init, MPI_Finalize, MPI_Comm_rank, MPI_COMM_WORLD
  implicit none

  character(len=*), parameter :: options = "-grid_n 128 -grid_size 2.6e-3 -friction 0.1 " // &
    "-body1_young 210e9 -body1_poisson 0.3 -body2_young 210e9 -body2_poisson 0.3 " // &
    "-gap_type sphere -gap_radius1 0.1 -gap_radius2 inf" // c_null_char
  real(c_double), parameter :: push(5) = [20d0, 40d0, 60d0, 0d0, -60d0]

  type(c_ptr) :: joint
  real(c_double) :: load(6), rigid(6), k(6, 6)
  integer :: code, rank, error, step

  call MPI_Init(error)
  call MPI_Comm_rank(MPI_COMM_WORLD, rank, error)
  code = petsam_create(int(MPI_COMM_WORLD, c_int), options, joint)
  do step = 1, size(push)
    if (code /= 0) exit
    code = petsam_try(joint, real(step, c_double), "load_n,load_tx" // c_null_char, [1000d0, push(step)], load, rigid)
    if (code == 0) code = petsam_stiffness(joint, 0_c_int, k)
    if (code == 0) code = petsam_commit(joint)
    if (code == 0 .and. rank == 0) print '(a,f7.2,a,es14.6,a,es13.6,a)', "T", load(2), " N  d_x", rigid(2), &
      " m  dT/dd_x", k(2, 2), " N/m"
  end do
  if (code /= 0 .and. rank == 0) write (error_unit, '(a)') petsam_message(joint)
  call petsam_destroy(joint)
  call MPI_Finalize(error)
  if (code /= 0) stop 1
end program
