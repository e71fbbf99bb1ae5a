// A fit that is asked for once more, with a little of it changed; the first one stays.
import { getFile, getRequest, submitFit, uploadImage } from "../api/calls";
import type { FitOptions, Job } from "../api/types";
import type { Picture } from "../draft/picture";
import type { Flips } from "../flip/flips";
import { remember, seen, thumbnailOf } from "../history/store";
import { fitAddress, go } from "../route";

/** Have the measurements in any case. */
export function measureAnyway(picture: Picture, job: Job): Promise<void> {
  return fitAgain(picture, job, () => ({ force: true }));
}

/** With limbs that point where it was said; what was said of others before holds. */
export function fitWithFlips(picture: Picture, job: Job, flips: Flips): Promise<void> {
  return fitAgain(picture, job, ({ limb_facing }) => ({ limb_facing: { ...limb_facing, ...flips } }));
}

/** Fit the same picture again, with its points and its mask, and go there. */
async function fitAgain(picture: Picture, job: Job, changed: (asked: FitOptions) => Partial<FitOptions>): Promise<void> {
  const upload = (file: Blob) => uploadImage(file, new AbortController().signal);
  const [asked, image, mask] = await Promise.all([
    getRequest(job),
    upload(picture.file),
    job.links.mask ? getFile(job.links.mask).then(upload) : null,
  ]);
  const begun = await submitFit({
    ...asked,
    ...changed(asked),
    image_id: image.id,
    ...(mask ? { mask_id: mask.id } : {}),
    ...(job.label ? { label: job.label } : {}),
  });
  seen(begun);
  remember({ id: begun.id, name: picture.name, startedAt: begun.created_at, thumbnail: thumbnailOf(picture.element) });
  go(fitAddress(begun.id));
}
