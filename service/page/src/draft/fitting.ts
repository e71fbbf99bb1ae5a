// Whether a picture has the size in which a person can be found.
import { LIMITS } from "../api/limits";
import { decimal } from "../messages/figures";
import { messages } from "../messages";
import type { Picture } from "./picture";

/** Raises an Error where no person could be found at that size. */
export async function fitting(shown: Picture, taken: () => Promise<Picture>): Promise<Picture> {
  const fault = sizeFault(shown);
  if (fault === null) return taken();
  URL.revokeObjectURL(shown.url);
  throw new Error(fault);
}

function sizeFault({ name, width, height }: Picture): string | null {
  const { tooSmall, tooNarrow } = messages.start;
  const size = `${decimal(width)} × ${decimal(height)}`;
  const [short, long] = [Math.min(width, height), Math.max(width, height)];
  if (short < LIMITS.leastSidePx) return tooSmall(name, size, decimal(LIMITS.leastSidePx));
  return long > LIMITS.largestAspectRatio * short ? tooNarrow(name, size, decimal(LIMITS.largestAspectRatio)) : null;
}
