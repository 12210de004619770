! petsam/creep.h in Fortran: compile this file, and external.c, and link both.
module petsam_creep
  use, intrinsic :: iso_c_binding
  implicit none

  integer(c_int), parameter :: petsam_creep_outside = 1, petsam_creep_invalid = 2

  type, bind(c) :: petsam_creep_contact
    real(c_double) :: shear, poisson        ! Pa, 1
    real(c_double) :: load, friction        ! N, 1
    real(c_double) :: half_x, half_y        ! m
    real(c_double) :: creep_x, creep_y      ! 1
    real(c_double) :: spin                  ! 1/m
  end type

  interface
    ! a table; its name ends with c_null_char; c_null_ptr and a message (256 bytes) after an error
    function petsam_creep_load(file, message) bind(c) result(table)
      import :: c_ptr, c_char
      character(kind=c_char), intent(in)  :: file(*)
      character(kind=c_char), intent(out) :: message(*)
      type(c_ptr)                         :: table
    end function

    ! Fx, Fy, Mz, and their derivative by xi, eta, phi, N: derivative(j, i) is that of force(i) by number j
    function petsam_creep_forces(table, contact, force, derivative) bind(c) result(status)
      import :: c_ptr, c_double, c_int, petsam_creep_contact
      type(c_ptr), value                     :: table
      type(petsam_creep_contact), intent(in) :: contact
      real(c_double), intent(out)            :: force(3), derivative(4, 3)
      integer(c_int)                         :: status
    end function

    ! the rigid slip over the rolled distance
    function petsam_creep_slip(contact) bind(c) result(slip)
      import :: c_double, petsam_creep_contact
      type(petsam_creep_contact), intent(in) :: contact
      real(c_double)                         :: slip
    end function

    subroutine petsam_creep_free(table) bind(c)
      import :: c_ptr
      type(c_ptr), value :: table
    end subroutine
  end interface
end module
