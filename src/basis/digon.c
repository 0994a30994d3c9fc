/* digon.c - taking away what will be turned below the horizon [gautron06] eq. 3.27.
 *
 * Invariant: of the digon and what it leaves, the narrower one is integrated, over d in [0, |beta|]
 * or [0, pi - |beta|] from its edge on the horizon, the only one where the functions are not
 * smooth: M = 1 - G(beta) for small angles, so that no digits are lost as beta goes to 0.
 *
 * beta > 0 moves +x down: the digon's edge is the half of the horizon at +x.  The other sign is the
 * mirror image, and so is the rest of the hemisphere. */
#include "basis/hsh_overlap.h"
#include "core/context.h"
#include "core/numerics.h"

assay_status assay_hsh_digon(const assay_basis *hsh, assay_context *context, double beta,
                             double *matrix_out)
{
    if (assay_basis_kind_of(hsh) != ASSAY_BASIS_HSH) {
        return assay_fail(context, ASSAY_ERR_ARGUMENT, "digon deletion needs the basis hsh, not %s",
                          assay_basis_kind_name(assay_basis_kind_of(hsh)));
    }
    const double angle = fabs(beta);
    if (!(angle <= ASSAY_PI)) {
        return assay_fail(context, ASSAY_ERR_DOMAIN,
                          "a digon of %g rad: the angle must be within -pi ... pi", beta);
    }
    const bool         deletes = angle <= 0.5 * ASSAY_PI;
    const double       width   = deletes ? angle : ASSAY_PI - angle;
    const assay_status status  = assay_hsh_overlap(hsh, context, 0.0, width, matrix_out);
    if (status) {
        return status;
    }
    const bool   mirrored = deletes ? beta < 0.0 : beta > 0.0;
    const size_t count    = assay_basis_count(hsh);
    for (size_t i = 0; i < count; i++) {
        const double si = assay_hsh_mirror_sign(hsh, i);
        for (size_t j = 0; j < count; j++) {
            const double sign         = mirrored ? si * assay_hsh_mirror_sign(hsh, j) : 1.0;
            const double g            = sign * matrix_out[i * count + j];
            matrix_out[i * count + j] = deletes ? (i == j ? 1.0 : 0.0) - g : g;
        }
    }
    return ASSAY_OK;
}
