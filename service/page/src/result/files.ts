// What a result view needs of the service, fetched together.
import { useEffect, useState } from "preact/hooks";
import { getFile, getResult } from "../api/calls";
import { problemFrom } from "../api/client";
import type { Fit, FitResult, Problem } from "../api/types";
import { readGlb } from "../viewer/glb";
import type { GlbBody } from "../viewer/glb";
import type { TapeLines } from "../viewer/Tapes";

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
  readonly result: FitResult | null;
  /** Null until all of them are there; of another picture until the body in the wanted one is. */
  readonly files: ResultFiles | null;
  /** How much of the bodies has come, from 0 to 1. */
  readonly loaded: number;
  readonly problem: Problem | null;
}

/** The result of a fit, and the body as it stands in the picture of this number. */
export function useResultFiles(fit: Fit, number: number): Fetched {
  const [result, setResult] = useState<FitResult | null>(null);
  const [files, setFiles] = useState<ResultFiles | null>(null);
  const [loaded, setLoaded] = useState(0);
  const [problem, setProblem] = useState<Problem | null>(null);
  const [leaving] = useState(() => new AbortController());
  const fail = (error: unknown) => leaving.signal.aborted || setProblem(problemFrom(error));
  useEffect(() => {
    const fetchAll = async () => {
      const found = await getResult(fit.id);
      if (leaving.signal.aborted) return;
      setResult(found);
      const count = progressOf(found, [posedIn(number), UPRIGHT], (share) => leaving.signal.aborted || setLoaded(share));
      const [posed, canonical, tapes] = await Promise.all([bodyOf(fit, posedIn(number), count), bodyOf(fit, UPRIGHT, count), tapesOf(fit)]);
      if (!leaving.signal.aborted) setFiles({ number, posed: posed!, canonical, tapes });
    };
    fetchAll().catch(fail);
    return () => leaving.abort();
  }, []);
  const isOther = files !== null && files.number !== number;
  useEffect(() => {
    if (!isOther) return undefined;
    let gone = false;
    bodyOf(fit, posedIn(number)).then((posed) => gone || setFiles({ ...files, number, posed: posed! }), fail);
    return () => {
      gone = true;
    };
  }, [number, isOther]);
  return { result, files, loaded, problem };
}

/** The name of a file that there is of each picture. */
export function nameOfView(number: number, name: string): string {
  return `views/${number}/${name}`;
}

function posedIn(number: number): string {
  return nameOfView(number, "body_posed.glb");
}

/** Counts bytes of some files as they come, and tells which share of all is there. */
function progressOf({ files }: Pick<FitResult, "files">, names: readonly string[], tell: (share: number) => void): (bytes: number) => void {
  const total = files.filter(({ name }) => names.includes(name)).reduce((sum, { size }) => sum + size, 0);
  let there = 0;
  return (bytes) => {
    there += bytes;
    if (total > 0) tell(Math.min(1, there / total));
  };
}

async function tapesOf(fit: Fit): Promise<TapeLines> {
  const path = fit.links.files["tapes.json"];
  return path ? (JSON.parse(await (await getFile(path)).text()) as { lines: TapeLines }).lines : {};
}

async function bodyOf(fit: Fit, name: string, onBytes?: (count: number) => void): Promise<GlbBody | null> {
  const path = fit.links.files[name];
  return path ? readGlb(await (await getFile(path, onBytes)).arrayBuffer()) : null;
}

/** A picture among the files as an address for an element; null until it is there. */
export function usePictureOf(links: { files: Readonly<Record<string, string>> }, name: string, wanted: boolean): string | null {
  const [made, setMade] = useState<{ path: string; url: string } | null>(null);
  const path = links.files[name];
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
