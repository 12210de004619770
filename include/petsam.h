/* petsam: partial-slip contact of elastic bodies by the semi-analytical method. All public headers. */
#ifndef PETSAM_H
#define PETSAM_H

#include <petsam/base.h>
#include <petsam/grid.h>
#include <petsam/parameters.h>
#include <petsam/body.h>
#include <petsam/gap.h>
#include <petsam/elasticity.h>
#include <petsam/balance.h>
#include <petsam/solver.h>
#include <petsam/normal.h>
#include <petsam/tangential.h>
#include <petsam/control.h>
#include <petsam/problem.h>
#include <petsam/contact.h>
#include <petsam/stiffness.h>
#include <petsam/wear.h>

#endif
