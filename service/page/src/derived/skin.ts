// The body in the picture's colours, which the page asks for by itself once a fit is there.
import { useEffect, useState } from "preact/hooks";
import { derive, getDerivation, listDerivations } from "../api/calls";
import { jobEvents } from "../api/events";
import type { Fit } from "../api/fits";
import type { Derivation } from "../api/types";
import { isActive } from "../fit/watch";

export interface Skin {
  /** `none` where it cannot be had. */
  readonly state: "coming" | "there" | "none";
  readonly path: string | null;
  /** The job that makes it, once it is asked for. */
  readonly id: string | null;
}

const COMING: Skin = { state: "coming", path: null, id: null };
const NONE: Skin = { state: "none", path: null, id: null };
const SIZE = 1024;

/** Asked for once the fit is known to be worth it. */
export function useSkin(fit: Fit, isWanted: boolean): Skin {
  const [skin, setSkin] = useState(COMING);
  useEffect(() => {
    if (!isWanted) return undefined;
    const leaving = new AbortController();
    const tell = (next: Skin) => leaving.signal.aborted || setSkin(next);
    made(fit, leaving.signal, (id) => tell({ ...COMING, id })).then(
      (job) => {
        const path = job.links.artifacts?.["body_textured.glb"];
        tell(path ? { state: "there", path, id: job.id } : NONE);
      },
      () => tell(NONE),
    );
    return () => leaving.abort();
  }, [isWanted]);
  return isWanted ? skin : NONE;
}

/** The first texture of a fit, whoever asked for it, at its end. */
async function made(fit: Fit, signal: AbortSignal, begun: (id: string) => void): Promise<Derivation> {
  const textures = (await listDerivations(fit)).filter(({ kind }) => kind === "texture");
  const job = textures.at(-1) ?? (await derive(fit, { kind: "texture", colours: "picture", size: SIZE }, null));
  begun(job.id);
  if (!isActive(job)) return job;
  for await (const { state } of jobEvents(job.links.events, signal)) if (!isActive({ state })) break;
  return getDerivation(job.links.self);
}
