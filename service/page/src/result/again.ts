// A fit that is asked for once more, with a little of it changed or by hand; the first one stays.
import { getAsked, getFile, getFit, submitFit, submitScan, uploadImage } from "../api/calls";
import { askedOfFit, askedOfView } from "../api/fits";
import type { Asked, AskedView, Fit, FitRef } from "../api/fits";
import type { FitOptions, ScanOfImages } from "../api/types";
import type { Picture } from "../draft/picture";
import type { FlipsOfViews } from "../flip/flips";
import { entries, remember, seen } from "../history/store";
import { reopen } from "../measure/send";
import { openAgain } from "../panel/open";
import { fitAddress, go } from "../route";

/** Take up what was asked for where it was prepared, to be changed and sent again. */
export function changeAgain(fit: Fit, pictures: readonly Picture[]): Promise<void> {
  return fit.kind === "fit" ? openAgain(fit, 0, pictures[0]!) : reopen(fit);
}

/** Have the measurements in any case. */
export function measureAnyway(fit: Fit): Promise<void> {
  return fitAgain(fit, (asked) => ({ ...asked, force: true }));
}

/** With limbs that point where it was said; what was said of others before holds. */
export function fitWithFlips(fit: Fit, flips: FlipsOfViews): Promise<void> {
  const turned = (view: AskedView, number: number) => ({ ...view, limb_facing: { ...view.limb_facing, ...flips[number] } });
  return fitAgain(fit, (asked) => ({ ...asked, views: asked.views.map(turned) }));
}

/** With the person and one of several pictures as they were prepared anew. */
export async function fitWithPicture({ number, ...which }: FitRef & { readonly number: number }, prepared: FitOptions, maskId: string | null): Promise<void> {
  const fit = await getFit(which);
  const { views, ...whole } = askedOfFit(prepared);
  const pictures = fit.pictures.map(({ image, mask }, at) => (at === number ? { image } : { image, mask }));
  const corrected = (view: AskedView, at: number) => (at === number ? { view: view.view, ...views[0]!, ...(maskId ? { mask_id: maskId } : {}) } : view);
  await fitAgain({ ...fit, pictures }, (asked) => ({ ...asked, ...whole, views: asked.views.map(corrected) }));
}

/** Fit the same pictures again, with their points and masks, and go there. */
async function fitAgain(fit: Fit, changed: (asked: Asked) => Asked): Promise<void> {
  const copy = async (path: string) => (await uploadImage(await getFile(path), new AbortController().signal)).id;
  const sent = async ({ image, mask }: Fit["pictures"][number]) => ({ image_id: await copy(image), ...(mask ? { mask_id: await copy(mask) } : {}) });
  const [asked, images] = await Promise.all([getAsked(fit).then(changed), Promise.all(fit.pictures.map(sent))]);
  const begun = await submitted(fit, asked, images);
  seen(begun);
  const known = entries.value.find(({ id }) => id === fit.id);
  if (known) remember({ ...known, id: begun.id, startedAt: begun.created_at });
  go(fitAddress(begun));
}

function submitted({ kind, label }: Fit, asked: Asked, images: readonly { image_id: string; mask_id?: string }[]): Promise<Fit> {
  const whole = label ? { label } : {};
  if (kind === "fit") return submitFit({ ...askedOfView(asked, 0), ...whole, ...images[0]! });
  const views = asked.views.map((view, number) => ({ ...view, ...images[number]! }));
  return submitScan({ ...asked, ...whole, views: views as ScanOfImages["views"] });
}
