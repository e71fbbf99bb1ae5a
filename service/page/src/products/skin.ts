// The body in the picture's colours, which the page asks for by itself once a fit is there.
import { useEffect, useState } from "preact/hooks";
import { made } from "./products";

export interface Skin {
  /** `none` where it cannot be had. */
  readonly state: "coming" | "there" | "none";
  readonly path: string | null;
}

const COMING: Skin = { state: "coming", path: null };
const NONE: Skin = { state: "none", path: null };

/** Asked for once the fit is known to be worth it. */
export function useSkin(fitId: string, isWanted: boolean): Skin {
  const [skin, setSkin] = useState(COMING);
  useEffect(() => {
    if (!isWanted) return undefined;
    const leaving = new AbortController();
    const tell = (next: Skin) => leaving.signal.aborted || setSkin(next);
    made(fitId, { kind: "texture", colours: "picture", size: 1024 }, null, leaving.signal).then(
      ({ links }) => {
        const path = links.files["body_textured.glb"];
        tell(path ? { state: "there", path } : NONE);
      },
      () => tell(NONE),
    );
    return () => leaving.abort();
  }, [isWanted]);
  return isWanted ? skin : NONE;
}
