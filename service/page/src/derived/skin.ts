// The body in the picture's colours, which the page asks for by itself once a fit is there.
import { useEffect, useState } from "preact/hooks";
import { derive, getAskedDerivation, getDerivation, listDerivations } from "../api/calls";
import { jobEvents } from "../api/events";
import type { Fit } from "../api/fits";
import type { Derivation, DerivationRequest } from "../api/types";
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
/** What the page asks for; textures of other colours or sizes are the caller's own. */
const ASKED = { kind: "texture", colours: "picture", size: 1024 } as const;

/** Asked for once the fit is known to be worth it. */
export function useSkin(fit: Fit, isWanted: boolean): Skin {
  const [skin, setSkin] = useState(COMING);
  useEffect(() => {
    if (!isWanted) return undefined;
    const leaving = new AbortController();
    const tell = (next: Skin) => leaving.signal.aborted || setSkin(next);
    made(fit, leaving.signal, (id) => tell({ ...COMING, id })).then(
      (job) => {
        const path = job.state === "succeeded" && job.links.artifacts?.["body_textured.glb"];
        tell(path ? { state: "there", path, id: job.id } : NONE);
      },
      () => tell(NONE),
    );
    return () => leaving.abort();
  }, [isWanted]);
  return isWanted ? skin : NONE;
}

/** The texture that is the skin, at its end. */
async function made(fit: Fit, signal: AbortSignal, begun: (id: string) => void): Promise<Derivation> {
  const textures = (await listDerivations(fit)).filter(({ kind }) => kind === "texture");
  const asked = await Promise.all(textures.map(async (job) => ({ job, asked: await getAskedDerivation(job) })));
  const job = skinAmong(asked) ?? (await derive(fit, ASKED, null));
  begun(job.id);
  if (!isActive(job)) return job;
  for await (const { state } of jobEvents(job.links.events, signal)) if (!isActive({ state })) break;
  return getDerivation(job.links.self);
}

/** Of textures, newest first, the first one asked for as the skin is; a failed one, which its card tells, only if no other is there. */
export function skinAmong<J extends Pick<Derivation, "state">>(textures: readonly { readonly job: J; readonly asked: DerivationRequest }[]): J | null {
  const skins = textures.filter(({ asked }) => asked.kind === "texture" && asked.colours === ASKED.colours && asked.size === ASKED.size).map(({ job }) => job);
  return skins.filter(({ state }) => state === "succeeded").at(-1) ?? skins.filter(isActive).at(-1) ?? skins.at(-1) ?? null;
}
