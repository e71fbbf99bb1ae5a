// What a result view needs of the service, fetched together.
import { useEffect, useState } from "preact/hooks";
import { getFile, getResult } from "../api/calls";
import { problemFrom } from "../api/client";
import { nameOfView } from "../api/fits";
import type { Fit, Result } from "../api/fits";
import type { Problem } from "../api/types";
import { readGlb } from "../viewer/glb";
import type { PosedAndUpright } from "../viewer/BodyScene";
import type { GlbBody } from "../viewer/glb";
import type { TapeLines } from "../viewer/Tapes";

const POSED = "body_posed.glb";
const UPRIGHT = "body_canonical.glb";

export interface ResultFiles {
  /** Of the picture that `posed` stands in. */
  readonly number: number;
  readonly posed: GlbBody;
  readonly canonical: GlbBody | null;
  /** Where measurements are taken on the canonical body. */
  readonly tapes: TapeLines;
}

export interface Fetched {
  /** There before the bodies, which are a hundred times its size. */
  readonly result: Result | null;
  /** Null until all of them are there; of another picture until the body in the wanted one is. */
  readonly files: ResultFiles | null;
  /** How much of the bodies has come, from 0 to 1. */
  readonly loaded: number;
  readonly problem: Problem | null;
}

/** The result of a fit, and the body as it stands in the picture of this number. */
export function useResultFiles(fit: Fit, number: number): Fetched {
  const [result, setResult] = useState<Result | null>(null);
  const [files, setFiles] = useState<ResultFiles | null>(null);
  const [loaded, setLoaded] = useState(0);
  const [problem, setProblem] = useState<Problem | null>(null);
  const [leaving] = useState(() => new AbortController());
  const fail = (error: unknown) => leaving.signal.aborted || setProblem(problemFrom(error));
  useEffect(() => {
    const fetchAll = async () => {
      const found = await getResult(fit);
      if (leaving.signal.aborted) return;
      setResult(found);
      const name = nameOfView(fit, POSED, number);
      const count = progressOf(found, [name, UPRIGHT], (share) => leaving.signal.aborted || setLoaded(share));
      const [posed, canonical, tapes] = await Promise.all([bodyOf(fit, name, count), bodyOf(fit, UPRIGHT, count), tapesOf(fit)]);
      if (!leaving.signal.aborted) setFiles({ number, posed: posed!, canonical, tapes });
    };
    fetchAll().catch(fail);
    return () => leaving.abort();
  }, []);
  const isOther = files !== null && files.number !== number;
  useEffect(() => {
    if (!isOther) return undefined;
    let gone = false;
    bodyOf(fit, nameOfView(fit, POSED, number)).then((posed) => gone || setFiles({ ...files, number, posed: posed! }), fail);
    return () => {
      gone = true;
    };
  }, [number, isOther]);
  return { result, files, loaded, problem };
}

/** Counts bytes of some files as they come, and tells which share of all is there. */
function progressOf({ artifacts }: Pick<Result, "artifacts">, names: readonly string[], tell: (share: number) => void): (bytes: number) => void {
  const total = artifacts.filter(({ name }) => names.includes(name)).reduce((sum, { size }) => sum + size, 0);
  let there = 0;
  return (bytes) => {
    there += bytes;
    if (total > 0) tell(Math.min(1, there / total));
  };
}

async function tapesOf(fit: Fit): Promise<TapeLines> {
  const path = fit.links.artifacts?.["tapes.json"];
  return path ? (JSON.parse(await (await getFile(path)).text()) as { lines: TapeLines }).lines : {};
}

/** The bodies as silhouette and edges left them, before shading; null until they are there. */
export function useBodiesBeforeShading(fit: Fit, number: number, wanted: boolean): PosedAndUpright | null {
  const [bodies, setBodies] = useState<(PosedAndUpright & { readonly number: number }) | null>(null);
  const isThere = bodies?.number === number;
  useEffect(() => {
    if (!wanted || isThere) return undefined;
    let gone = false;
    Promise.all([bodyOf(fit, nameOfView(fit, POSED_BEFORE_SHADING, number)), bodyOf(fit, "body_canonical_se.glb")]).then(
      ([posed, canonical]) => gone || setBodies(posed && { number, posed, canonical }),
      () => undefined,
    );
    return () => {
      gone = true;
    };
  }, [number, wanted, isThere]);
  return isThere ? bodies : null;
}

/** Whether the body before shading can be had. */
export function isComparable({ kind, links }: Fit): boolean {
  return links.artifacts?.[nameOfView({ kind }, POSED_BEFORE_SHADING, 0)] !== undefined;
}

const POSED_BEFORE_SHADING = "body_posed_se.glb";

/** Name and path of the measurements as a table: written when it is asked for, so that no link leads to it. */
export function tableOf(job: { links: { self: string } }): [string, string] {
  return ["measurements.csv", `${job.links.self}/artifacts/measurements.csv`];
}

async function bodyOf(fit: Fit, name: string, onBytes?: (count: number) => void): Promise<GlbBody | null> {
  const path = fit.links.artifacts?.[name];
  return path ? readGlb(await (await getFile(path, onBytes)).arrayBuffer()) : null;
}

/** A picture of the result as an address for an element; null until it is there. */
export function usePictureOf(job: { links: { artifacts?: Readonly<Record<string, string>> } }, name: string, wanted: boolean): string | null {
  const [made, setMade] = useState<{ path: string; url: string } | null>(null);
  const path = job.links.artifacts?.[name];
  useEffect(() => {
    if (!wanted || !path) return undefined;
    let url: string | null = null;
    let gone = false;
    getFile(path).then(
      (file) => {
        if (gone) return;
        url = URL.createObjectURL(file);
        setMade({ path, url });
      },
      () => undefined,
    );
    return () => {
      gone = true;
      if (url) URL.revokeObjectURL(url);
      setMade(null);
    };
  }, [path, wanted]);
  // Effects run after what they belong to is shown: until then the picture of another file is still there.
  return wanted && made && made.path === path ? made.url : null;
}
