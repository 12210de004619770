! The functions of petsam/embed.h for Fortran: what they do and return is said there.
!
! Texts end with c_null_char. Arrays are those of C: the first cell of a row comes first, and k(j, i) is the stiffness
! of load i and displacement j.
module petsam
  use, intrinsic :: iso_c_binding
  implicit none

  integer(c_int), parameter :: petsam_alone = -1_c_int ! the communicator of this process alone

  interface
    integer(c_int) function petsam_create(comm, options, contact) bind(c)
      import :: c_int, c_char, c_ptr
      integer(c_int), value :: comm
      character(kind=c_char), intent(in) :: options(*)
      type(c_ptr), intent(out) :: contact
    end function

    integer(c_int) function petsam_grid(contact, n, size, center, first_row, rows) bind(c)
      import :: c_int, c_double, c_ptr
      type(c_ptr), value :: contact
      integer(c_int), intent(out) :: n(2), first_row, rows
      real(c_double), intent(out) :: size(2), center(2)
    end function

    integer(c_int) function petsam_set_field(contact, name, values) bind(c)
      import :: c_int, c_char, c_double, c_ptr
      type(c_ptr), value :: contact
      character(kind=c_char), intent(in) :: name(*)
      real(c_double), intent(in) :: values(*)
    end function

    integer(c_int) function petsam_try(contact, time, names, values, load, rigid) bind(c)
      import :: c_int, c_char, c_double, c_ptr
      type(c_ptr), value :: contact
      real(c_double), value :: time
      character(kind=c_char), intent(in) :: names(*)
      real(c_double), intent(in) :: values(*)
      real(c_double), intent(out) :: load(6), rigid(6)
    end function

    integer(c_int) function petsam_commit(contact) bind(c)
      import :: c_int, c_ptr
      type(c_ptr), value :: contact
    end function

    integer(c_int) function petsam_reject(contact) bind(c)
      import :: c_int, c_ptr
      type(c_ptr), value :: contact
    end function

    integer(c_int) function petsam_stiffness(contact, reversal, k) bind(c)
      import :: c_int, c_double, c_ptr
      type(c_ptr), value :: contact
      integer(c_int), value :: reversal
      real(c_double), intent(out) :: k(6, 6)
    end function

    integer(c_int) function petsam_stiffness_with(contact, reversal, cases, k) bind(c)
      import :: c_int, c_char, c_double, c_ptr
      type(c_ptr), value :: contact
      integer(c_int), value :: reversal
      character(c_char), intent(in) :: cases(*)
      real(c_double), intent(out) :: k(*)
    end function

    integer(c_int) function petsam_get_field(contact, name, values) bind(c)
      import :: c_int, c_char, c_double, c_ptr
      type(c_ptr), value :: contact
      character(kind=c_char), intent(in) :: name(*)
      real(c_double), intent(out) :: values(*)
    end function

    integer(c_int) function petsam_get_number(contact, name, value) bind(c)
      import :: c_int, c_char, c_double, c_ptr
      type(c_ptr), value :: contact
      character(kind=c_char), intent(in) :: name(*)
      real(c_double), intent(out) :: value
    end function

    integer(c_int) function petsam_stress(contact, options, shape) bind(c)
      import :: c_int, c_char, c_ptr
      type(c_ptr), value :: contact
      character(kind=c_char), intent(in) :: options(*)
      integer(c_int), intent(out) :: shape(4)
    end function

    integer(c_int) function petsam_record(contact, on) bind(c)
      import :: c_int, c_ptr
      type(c_ptr), value :: contact
      integer(c_int), value :: on
    end function

    integer(c_int) function petsam_fatigue(contact, options, shape) bind(c)
      import :: c_int, c_char, c_ptr
      type(c_ptr), value :: contact
      character(kind=c_char), intent(in) :: options(*)
      integer(c_int), intent(out) :: shape(4)
    end function

    integer(c_int) function petsam_get_stress(contact, name, values) bind(c)
      import :: c_int, c_char, c_double, c_ptr
      type(c_ptr), value :: contact
      character(kind=c_char), intent(in) :: name(*)
      real(c_double), intent(out) :: values(*)
    end function

    integer(c_int) function petsam_save(contact, file) bind(c)
      import :: c_int, c_char, c_ptr
      type(c_ptr), value :: contact
      character(kind=c_char), intent(in) :: file(*)
    end function

    integer(c_int) function petsam_load(contact, file) bind(c)
      import :: c_int, c_char, c_ptr
      type(c_ptr), value :: contact
      character(kind=c_char), intent(in) :: file(*)
    end function

    subroutine petsam_destroy(contact) bind(c)
      import :: c_ptr
      type(c_ptr), intent(inout) :: contact
    end subroutine

    type(c_ptr) function petsam_c_message(contact) bind(c, name="petsam_message")
      import :: c_ptr
      type(c_ptr), value :: contact
    end function

    integer(c_size_t) function petsam_c_length(text) bind(c, name="strlen")
      import :: c_size_t, c_ptr
      type(c_ptr), value :: text
    end function
  end interface

contains

  ! What was wrong with the last call, or a warning; of petsam_create() for c_null_ptr.
  function petsam_message(contact) result(text)
    type(c_ptr), intent(in) :: contact
    character(len=:), allocatable :: text
    character(kind=c_char), pointer :: letters(:)
    type(c_ptr) :: at
    integer :: k

    at = petsam_c_message(contact)
    call c_f_pointer(at, letters, [petsam_c_length(at)])
    allocate (character(len=size(letters)) :: text)
    do k = 1, size(letters)
      text(k:k) = letters(k)
    end do
  end function
end module
