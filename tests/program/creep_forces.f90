! Prints forces and derivative of one contact: creep_forces TABLE
program creep_forces
  use petsam_creep
  implicit none
  type(petsam_creep_contact) :: contact
  type(c_ptr)                :: table
  character(kind=c_char)     :: message(256)
  character(len=1000)        :: name
  real(c_double)             :: force(3), derivative(4, 3)
  integer(c_int)             :: status

  call get_command_argument(1, name)
  table = petsam_creep_load(trim(name) // c_null_char, message)
  if (.not. c_associated(table)) stop 1
  contact = petsam_creep_contact(82d9, 0.28d0, 1d5, 0.3d0, 5d-3, 4d-3, 1d-3, -2d-3, 0.3d0)
  status = petsam_creep_forces(table, contact, force, derivative)
  print '(i0)', status
  print '(es25.16e3)', force, derivative, petsam_creep_slip(contact)
  call petsam_creep_free(table)
end program
