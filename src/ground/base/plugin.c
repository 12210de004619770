/* Plugins: shared libraries that register further types of gap, law, elasticity and solver. */
#include <petsam/private/baseimpl.h>
#include <petsam/private/base.h>
#include <dlfcn.h>

#define FUNCTION "SamPluginRegister"

typedef PetscErrorCode (*Register)(void);

/* Loads a file on this rank. As for other files, a name without a folder is in the current folder. Returns NULL and
   `fault` on failure. */
static Register Load(const char file[], char fault[], size_t size)
{
  char     name[PETSC_MAX_PATH_LEN + 2];
  void    *handle, *shared;
  Register function = NULL;

  (void)snprintf(name, sizeof(name), "%s%s", strchr(file, '/') ? "" : "./", file);
  handle = dlopen(name, RTLD_NOW | RTLD_LOCAL);
  if (!handle) {
    (void)snprintf(fault, size, "cannot be loaded: %s", dlerror());
    return NULL;
  }
  shared              = dlsym(handle, "SamFinalize");
  *(void **)&function = dlsym(handle, FUNCTION);
  if (!function) {
    (void)snprintf(fault, size, "has no function " FUNCTION "(): expected one that registers its types");
  } else if (shared && shared != *(void **)&(Register){SamFinalize}) {
    (void)snprintf(fault, size, "uses another copy of libpetsam than this program: link both with the same shared one");
    function = NULL;
  }
  return function;
}

PetscErrorCode SamOptionsPlugins(const SamOptions *from)
{
  static const SamOptionRow row = {"plugin", "shared libraries with further types, separated by commas",
                                   SAM_OPTION_FILES, .size = PETSC_MAX_PATH_LEN};
  char                      files[PETSC_MAX_PATH_LEN] = "", **file, fault[SAM_MESSAGE];
  int                       count;
  double                    failed = 0;

  PetscFunctionBegin;
  SamValidPointer(from, 1);
  PetscCall(SamOptionsRead(from, "Plugins", 1, &row, files, NULL));
  PetscCall(PetscStrToArray(files, ',', &count, &file));
  PetscCheck(count || !files[0], from->comm, SAM_ERR_USER, "-%splugin %s: expected the name of a file",
             SamOptionsPrefix(from), files);
  for (int k = 0; k < count; k++) {
    const Register function = Load(file[k], fault, sizeof(fault));

    failed = function ? 0 : 1;
    PetscCall(SamMax(from->comm, 1, &failed));
    PetscCheck(!failed, from->comm, SAM_ERR_FILE, "-%splugin %s: %s", SamOptionsPrefix(from), file[k],
               function ? "cannot be loaded on another rank" : fault);
    PetscCall((*function)());
  }
  PetscCall(PetscStrToArrayDestroy(count, file));
  PetscFunctionReturn(PETSC_SUCCESS);
}
