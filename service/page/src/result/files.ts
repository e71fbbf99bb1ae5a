// What a result view needs of the service, fetched together.
import { useEffect, useState } from "preact/hooks";
import { getFile, getResult } from "../api/calls";
import { problemFrom } from "../api/client";
import type { FitResult, Job, Problem, Scan } from "../api/types";
import { readGlb } from "../viewer/glb";
import type { PosedAndUpright } from "../viewer/BodyScene";
import type { GlbBody } from "../viewer/glb";
import type { TapeLines } from "../viewer/Tapes";

export interface FilesOf<Result> {
  readonly result: Result;
  readonly posed: GlbBody;
  readonly canonical: GlbBody | null;
  /** Where measurements are taken on the canonical body. */
  readonly tapes: TapeLines;
}

export type ResultFiles = FilesOf<FitResult>;

export interface Fetched<Result> {
  /** Null until they are there. */
  readonly files: FilesOf<Result> | null;
  readonly problem: Problem | null;
}

export function useResultFiles(job: Job): Fetched<FitResult> {
  return useFilesOf(job, () => getResult(job), "body_posed.glb");
}

/** The result and the files of a job; `posed` is the body as it stands in the picture that is shown. */
export function useFilesOf<Result>(job: Job | Scan, result: () => Promise<Result>, posedName: string): Fetched<Result> {
  const [files, setFiles] = useState<FilesOf<Result> | null>(null);
  const [problem, setProblem] = useState<Problem | null>(null);
  useEffect(() => {
    let gone = false;
    setFiles(null);
    const tapesOf = async () => {
      const path = job.links.artifacts?.["tapes.json"];
      return path ? (JSON.parse(await (await getFile(path)).text()) as { lines: TapeLines }).lines : {};
    };
    Promise.all([result(), bodyOf(job, posedName), bodyOf(job, "body_canonical.glb"), tapesOf()]).then(
      ([found, posed, canonical, tapes]) => gone || setFiles({ result: found, posed: posed!, canonical, tapes }),
      (error) => gone || setProblem(problemFrom(error)),
    );
    return () => {
      gone = true;
    };
  }, [job.id]);
  return { files, problem };
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

async function bodyOf(job: Job | Scan, name: string): Promise<GlbBody | null> {
  const path = job.links.artifacts?.[name];
  return path ? readGlb(await (await getFile(path)).arrayBuffer()) : null;
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
