/* The options of the law of wear. */
#include <petsam/private/baseimpl.h>
#include <petsam/setup.h>

/* One law's coefficients of both bodies; `given`: one of them is set. */
static PetscErrorCode ReadLaw(const SamOptions *from, const char name[], const char text[], PetscReal coefficient[2],
                              PetscBool *given)
{
  PetscFunctionBegin;
  *given = PETSC_FALSE;
  for (int body = 0; body < 2; body++) {
    char      option[32], help[96];
    PetscBool set;

    PetscCall(PetscSNPrintf(option, sizeof(option), "%s%d", name, body + 1));
    PetscCall(PetscSNPrintf(help, sizeof(help), "%s of body %d", text, body + 1));
    PetscCall(SamOptionsReal(from, option, help, SAM_RANGE_NONNEGATIVE, &coefficient[body], &set));
    if (set) *given = PETSC_TRUE;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamWearLawsSetFromOptions(SamWearLaws *w, const SamOptions *from)
{
  PetscReal archard[2] = {0, 0}, energy[2] = {0, 0};
  PetscBool given[2];

  PetscFunctionBegin;
  PetscCall(ReadLaw(from, "wear_coefficient", "Archard's wear, depth = k p |ds|: k (1/Pa)", archard, &given[0]));
  PetscCall(ReadLaw(from, "wear_energy", "wear by energy, depth = alpha |q.ds|: alpha (m3/J)", energy, &given[1]));
  PetscCheck(!given[0] || !given[1], from->comm, SAM_ERR_USER,
             "-wear_coefficient1 or 2 and -wear_energy1 or 2 are given: a run has one law of wear");
  w->law = given[1] ? SAM_WEAR_ENERGY : SAM_WEAR_ARCHARD;
  PetscCall(PetscArraycpy(w->coefficient, given[1] ? energy : archard, 2));
  w->on = w->coefficient[0] + w->coefficient[1] > 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamWearLawsAddParameters(const SamWearLaws *w, const char kind[], SamParameters *p)
{
  const char *const name = w->law == SAM_WEAR_ENERGY ? "wear_energy" : "wear_coefficient";

  PetscFunctionBegin;
  PetscCall(SamParametersAddText(p, "wear", PETSC_TRUE, w->on ? kind : "none"));
  for (int body = 0; body < 2 && w->on; body++) {
    char option[32];

    PetscCall(PetscSNPrintf(option, sizeof(option), "%s%d", name, body + 1));
    PetscCall(SamParametersAddReals(p, option, PETSC_TRUE, 1, &w->coefficient[body]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
