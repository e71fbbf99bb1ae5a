// A fit that is asked for once more with something of it changed; the first one stays.
import { getAsked, getFile, submitFit, uploadImage } from "../api/calls";
import type { Fit, FitRequest } from "../api/types";
import type { FlipsOfViews } from "../flip/flips";
import { entries, remember, seen } from "../history/store";
import { fitAddress, go } from "../route";

/** Have the measurements in any case. */
export function measureAnyway(fit: Fit): Promise<void> {
  return fitAgain(fit, (asked) => ({ ...asked, force: true }));
}

/** With limbs that point where it was said; what was said of others before holds. */
export function fitWithFlips(fit: Fit, flips: FlipsOfViews): Promise<void> {
  return fitAgain(fit, (asked) => ({
    ...asked,
    views: asked.views?.map((view, number) => ({ ...view, limb_facing: { ...view.limb_facing, ...flips[number] } })),
  }));
}

/** Fit the same pictures again, with their points and masks, and go there. */
async function fitAgain(fit: Fit, changed: (asked: FitRequest) => FitRequest): Promise<void> {
  const asked = changed(await getAsked(fit.id));
  const copy = async (name: string) => {
    const path = fit.links.files[name];
    return path && (await uploadImage(await getFile(path))).id;
  };
  const views = (asked.views ?? [{}]).map(async (view, number) => ({
    ...view,
    image_id: await copy(`views/${number}/image`),
    mask_id: await copy(`views/${number}/mask`),
  }));
  const begun = await submitFit({ ...asked, views: (await Promise.all(views)) as FitRequest["views"] });
  seen(begun);
  const known = entries.value.find(({ id }) => id === fit.id);
  if (known) remember({ id: begun.id, name: known.name, thumbnail: known.thumbnail, startedAt: begun.created_at });
  go(fitAddress(begun.id));
}
