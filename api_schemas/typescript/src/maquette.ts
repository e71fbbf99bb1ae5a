// Maquette's HTTP API for browsers and Node: `fit` or `scan` pictures, `waitFor` the job, take its `result` and files.
// All types are those of openapi.json.
import type { components } from "./schema.js";

export type Schemas = components["schemas"];
export type FitRequest = Schemas["FitRequest"];
export type FitResult = Schemas["FitResult"];
export type Job = Schemas["Job"];
export type Measurement = Schemas["Measurement"];
export type Problem = Schemas["Problem"];
export type Scan = Schemas["Scan"];
export type ScanRequest = Schemas["ScanRequest"];
export type ScanResult = Schemas["ScanResult"];

export interface Options {
  /** Where the service is, `https://measure.example.org`; in a browser the page's own origin if it is left out. */
  readonly address?: string;
  /** A key on a server, a visitor's token in a browser; or what brings one, asked before each call. */
  readonly token?: string | (() => string | Promise<string>);
  readonly fetch?: typeof fetch;
}

export interface Sending {
  /** White on the person: in place of the segmentation. */
  readonly mask?: Blob;
  /** How long the answer may wait for the job's end, in seconds: 30 if it is left out, at most 60. */
  readonly wait?: number;
  /** The same key with the same content gives the same job, however often it is sent. */
  readonly idempotencyKey?: string;
  readonly signal?: AbortSignal;
}

export interface SendingScan extends Omit<Sending, "mask"> {
  /** By the pictures' places. */
  readonly masks?: readonly (Blob | undefined)[];
}

export interface Waiting<J> {
  readonly onProgress?: (job: J) => void;
  readonly signal?: AbortSignal;
}

/** The service refused a call, or a job has no result. `problem` says which field, why, and what to do. */
export class MaquetteError extends Error {
  override readonly name = "MaquetteError";
  readonly status: number;
  readonly problem: Problem | null;

  constructor(message: string, status: number, problem: Problem | null) {
    super(message);
    this.status = status;
    this.problem = problem;
  }
}

const DEFAULT_WAIT_S = 30;
const POLL_MS = 1_000;
const PROBLEM = "application/problem+json";

export class Maquette {
  readonly #address: string;
  readonly #token: Options["token"];
  readonly #fetch: typeof fetch;

  constructor(options: Options = {}) {
    this.#address = (options.address ?? "").replace(/\/$/, "");
    this.#token = options.token;
    this.#fetch = options.fetch ?? globalThis.fetch.bind(globalThis);
  }

  /** Send one picture. The job may have ended already: `waitFor` it. */
  fit(picture: Blob, request: FitRequest, sending: Sending = {}): Promise<Job> {
    return this.#send("/v1/fits", { image: picture, mask: sending.mask }, request, sending);
  }

  /** Send two to six pictures of one person, in the order of the request's `views`. */
  scan(pictures: readonly Blob[], request: ScanRequest, sending: SendingScan = {}): Promise<Scan> {
    const parts: Record<string, Blob | undefined> = {};
    pictures.forEach((picture, number) => (parts[`image_${number}`] = picture));
    sending.masks?.forEach((mask, number) => (parts[`mask_${number}`] = mask));
    return this.#send("/v1/scans", parts, request, sending);
  }

  /** Resolves once the job has succeeded; rejects with a `MaquetteError` if it ended otherwise. */
  async waitFor<J extends Job | Scan>(job: J, { onProgress, signal }: Waiting<J> = {}): Promise<J> {
    let seen = job;
    for (;;) {
      onProgress?.(seen);
      if (seen.state === "succeeded") return seen;
      if (seen.state !== "queued" && seen.state !== "running") throw failure(seen.problem, 409, `The job ended as ${seen.state}.`);
      await pause(POLL_MS, signal);
      seen = await json<J>(await this.#call(seen.links.self, signal ? { signal } : {}));
    }
  }

  /** What a job that succeeded has found; `stages` is empty unless it is asked for. */
  result(job: Job, asked?: { readonly stages?: boolean }): Promise<FitResult>;
  result(scan: Scan, asked?: { readonly stages?: boolean }): Promise<ScanResult>;
  async result(job: Job | Scan, asked: { readonly stages?: boolean } = {}): Promise<FitResult | ScanResult> {
    const query = asked.stages ? "?include=stages" : "";
    return json(await this.#call(`${job.links.self}/result${query}`, {}));
  }

  /** One of its files: `body_posed.glb`, `overlay.png`, or, made when asked for, `body_posed.obj`, `measurements.csv`. */
  async artifact(job: Job | Scan, name: string): Promise<Blob> {
    return (await this.#call(`${job.links.self}/artifacts/${encodeURIComponent(name)}`, {})).blob();
  }

  /** Stop it if it runs, and erase its pictures and results. */
  async erase(job: Job | Scan): Promise<void> {
    await this.#call(job.links.self, { method: "DELETE" });
  }

  async #send<J>(path: string, parts: Readonly<Record<string, Blob | undefined>>, request: unknown, sending: Omit<Sending, "mask">): Promise<J> {
    const form = new FormData();
    form.append("request", new Blob([JSON.stringify(request)], { type: "application/json" }), "request.json");
    for (const [name, part] of Object.entries(parts)) if (part) form.append(name, part, name);
    const headers: Record<string, string> = { Prefer: `wait=${sending.wait ?? DEFAULT_WAIT_S}` };
    if (sending.idempotencyKey !== undefined) headers["Idempotency-Key"] = sending.idempotencyKey;
    return json(await this.#call(path, { method: "POST", body: form, headers, ...(sending.signal && { signal: sending.signal }) }));
  }

  async #call(path: string, init: RequestInit): Promise<Response> {
    const headers = new Headers(init.headers);
    const token = typeof this.#token === "function" ? await this.#token() : this.#token;
    if (token !== undefined) headers.set("Authorization", `Bearer ${token}`);
    const response = await this.#fetch(this.#address + path, { ...init, headers });
    if (response.ok) return response;
    const isProblem = response.headers.get("Content-Type")?.startsWith(PROBLEM);
    throw failure(isProblem ? await json<Problem>(response) : null, response.status, `The service answered ${response.status}.`);
  }
}

function failure(problem: Problem | null, status: number, otherwise: string): MaquetteError {
  const message = problem ? `${problem.detail} ${problem.remedy}`.trim() : otherwise;
  return new MaquetteError(message, problem?.status ?? status, problem);
}

async function json<T>(response: Response): Promise<T> {
  return (await response.json()) as T;
}

async function pause(milliseconds: number, signal: AbortSignal | undefined): Promise<void> {
  signal?.throwIfAborted();
  const ended = new AbortController();
  try {
    await new Promise<void>((resume, reject) => {
      setTimeout(resume, milliseconds);
      signal?.addEventListener("abort", () => reject(signal.reason), { signal: ended.signal });
    });
  } finally {
    ended.abort();
  }
}
