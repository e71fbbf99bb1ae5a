// What a result view needs of the service, fetched together.
import { useEffect, useState } from "preact/hooks";
import { getFile, getResult } from "../api/calls";
import { problemFrom } from "../api/client";
import type { FitResult, Job, Problem, Scan } from "../api/types";
import { readGlb } from "../viewer/glb";
import type { PosedAndUpright } from "../viewer/BodyScene";
import type { GlbBody } from "../viewer/glb";
import type { TapeLines } from "../viewer/Tapes";

const UPRIGHT = "body_canonical.glb";

export interface FilesOf<Result> {
  readonly result: Result;
  readonly posed: GlbBody;
  readonly canonical: GlbBody | null;
  /** Where measurements are taken on the canonical body. */
  readonly tapes: TapeLines;
}

export type ResultFiles = FilesOf<FitResult>;

export interface Fetched<Result> {
  /** There before the bodies, which are a hundred times its size. */
  readonly result: Result | null;
  /** Null until all of them are there. */
  readonly files: FilesOf<Result> | null;
  /** How much of the bodies has come, from 0 to 1. */
  readonly loaded: number;
  readonly problem: Problem | null;
}

type Listing = Pick<FitResult, "artifacts">;

export function useResultFiles(job: Job): Fetched<FitResult> {
  return useFilesOf(job, () => getResult(job), "body_posed.glb");
}

/** The result and then the files of a job; `posed` is the body as it stands in the picture that is shown. */
export function useFilesOf<Result extends Listing>(job: Job | Scan, fetchResult: () => Promise<Result>, posedName: string): Fetched<Result> {
  const [result, setResult] = useState<Result | null>(null);
  const [files, setFiles] = useState<FilesOf<Result> | null>(null);
  const [loaded, setLoaded] = useState(0);
  const [problem, setProblem] = useState<Problem | null>(null);
  useEffect(() => {
    let gone = false;
    setResult(null);
    setFiles(null);
    setLoaded(0);
    const fetchAll = async () => {
      const found = await fetchResult();
      if (gone) return;
      setResult(found);
      const count = progressOf(found, [posedName, UPRIGHT], (share) => gone || setLoaded(share));
      const tapes = tapesOf(job);
      const [posed, canonical] = await Promise.all([bodyOf(job, posedName, count), bodyOf(job, UPRIGHT, count)]);
      const lines = await tapes;
      if (!gone) setFiles({ result: found, posed: posed!, canonical, tapes: lines });
    };
    fetchAll().catch((error) => gone || setProblem(problemFrom(error)));
    return () => {
      gone = true;
    };
  }, [job.id]);
  return { result, files, loaded, problem };
}

/** Counts bytes of some files as they come, and tells which share of all is there. */
function progressOf({ artifacts }: Listing, names: readonly string[], tell: (share: number) => void): (bytes: number) => void {
  const total = artifacts.filter(({ name }) => names.includes(name)).reduce((sum, { size }) => sum + size, 0);
  let there = 0;
  return (bytes) => {
    there += bytes;
    if (total > 0) tell(Math.min(1, there / total));
  };
}

async function tapesOf(job: Job | Scan): Promise<TapeLines> {
  const path = job.links.artifacts?.["tapes.json"];
  return path ? (JSON.parse(await (await getFile(path)).text()) as { lines: TapeLines }).lines : {};
}

/** The bodies as silhouette and edges left them, before shading; null until they are there. */
export function useBodiesBeforeShading(job: Job, wanted: boolean): PosedAndUpright | null {
  const [bodies, setBodies] = useState<PosedAndUpright | null>(null);
  useEffect(() => {
    if (!wanted || bodies) return undefined;
    let gone = false;
    Promise.all([bodyOf(job, "body_posed_se.glb"), bodyOf(job, "body_canonical_se.glb")]).then(
      ([posed, canonical]) => gone || setBodies(posed && { posed, canonical }),
      () => undefined,
    );
    return () => {
      gone = true;
    };
  }, [job.id, wanted]);
  return bodies;
}

/** Name and path of the measurements as a table: written when it is asked for, so that no link leads to it. */
export function tableOf(job: { links: { self: string } }): [string, string] {
  return ["measurements.csv", `${job.links.self}/artifacts/measurements.csv`];
}

async function bodyOf(job: Job | Scan, name: string, onBytes?: (count: number) => void): Promise<GlbBody | null> {
  const path = job.links.artifacts?.[name];
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
