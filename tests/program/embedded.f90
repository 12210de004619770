! The same steps as embedded.c on all ranks of MPI: loads and displacements to the last bit.
program embedded
  use, intrinsic :: iso_c_binding
  use petsam
  use mpi, only: MPI_Init, MPI_Finalize, MPI_Comm_rank, MPI_COMM_WORLD
  implicit none
  character(len=4096) :: options
  type(c_ptr) :: c
  real(c_double) :: value(6), load(6), rigid(6), x
  character(len=*), parameter :: names = "load_n,disp_x,load_ty,load_mx,load_my,load_mz" // c_null_char
  integer :: code, rank, error, step

  call get_command_argument(1, options)
  call MPI_Init(error)
  call MPI_Comm_rank(MPI_COMM_WORLD, rank, error)
  code = petsam_create(int(MPI_COMM_WORLD, c_int), trim(options) // c_null_char, c)
  do step = 1, 5
    if (code /= 0) exit
    x = 1.3d0 * step
    if (step > 3) x = 1.3d0 * (6 - step) - 1.9d0
    value = [900d0 + 30 * step, 1d-7 * x, 5d0, 0d0, 0.01d0, 0d0]
    if (step < 5) then
      code = petsam_try(c, real(step, c_double), names, value, load, rigid)
    else
      code = petsam_try(c, 5d0, "load_n,disp_x,load_ty,load_my" // c_null_char, value([1, 2, 3, 5]), load, rigid)
    end if
    if (code == 0) code = petsam_commit(c)
    if (code == 0 .and. rank == 0) print '(12(z16.16,1x))', load, rigid
  end do
  if (code == 0) then
    if (petsam_try(c, 9d0, "load_n,load_tx" // c_null_char, [900d0, 1d5], load, rigid) /= 11) code = 1
    if (rank == 0) print '(a)', petsam_message(c)
  else if (rank == 0) then
    print '(a)', petsam_message(c)
  end if
  call petsam_destroy(c)
  call MPI_Finalize(error)
  if (code /= 0) stop 1
end program
