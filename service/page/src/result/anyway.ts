// A fit whose measurements are withheld, asked for once more.
import { getFile, getRequest, submitFit, uploadImage } from "../api/calls";
import type { Job } from "../api/types";
import type { Picture } from "../draft/picture";
import { remember, seen, thumbnailOf } from "../history/store";
import { fitAddress, go } from "../route";

/** Fit the same picture again, with its points and its mask, and have the measurements in any case. */
export async function measureAnyway(picture: Picture, job: Job): Promise<void> {
  const upload = (file: Blob) => uploadImage(file, new AbortController().signal);
  const [asked, image, mask] = await Promise.all([
    getRequest(job),
    upload(picture.file),
    job.links.mask ? getFile(job.links.mask).then(upload) : null,
  ]);
  const begun = await submitFit({ ...asked, force: true, image_id: image.id, ...(mask ? { mask_id: mask.id } : {}) });
  seen(begun);
  remember({ id: begun.id, name: picture.name, startedAt: begun.created_at, thumbnail: thumbnailOf(picture.element) });
  go(fitAddress(begun.id));
}
