/* verify_chance.h - whether light that is missing may be missing by chance, where the candidate has
 * no variance of its own samples. */
#ifndef ASSAY_ORACLE_VERIFY_CHANCE_H
#define ASSAY_ORACLE_VERIFY_CHANCE_H

#include "oracle/image/verify_judge.h"

enum { ASSAY_CHANCE_TEXT = ASSAY_MEANING_SIZE + 256 };

/* The share of the reference's samples that a candidate must have taken, at least, for the lack of
 * light to be too much for chance; 0 where there is no lack, or where chance is ruled out. */
double assay_chance_share(const assay_verify_channel *channel, int level,
                          const assay_noisy_sums *sums, assay_critical_values *critical);

/* Of a finding that fails: says in its meaning from how many samples on that stands, in `text`,
 * where the candidate is not known to have as many; takes the failure of a single image back there.
 * sums: of the surest region, whose share is given. */
void assay_chance_ask(assay_finding *finding, const assay_judgement *judgement,
                      const assay_verify_channel *channel, const assay_noisy_sums *sums,
                      double share, char text[ASSAY_CHANCE_TEXT]);

#endif
