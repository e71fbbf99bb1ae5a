// Maquette's HTTP API for browsers and Node: `fit` pictures, `waitFor` the end, take `result` and files.
// All types are those of openapi.json.
import type { components } from "./schema.js";

export type Schemas = components["schemas"];
export type Fit = Schemas["Fit"];
export type FitRequest = Schemas["FitRequest"];
export type FitResult = Schemas["FitResult"];
export type Measurement = Schemas["Measurement"];
export type Problem = Schemas["Problem"];

export interface Options {
  /** Where the service is, `https://measure.example.org`; in a browser the page's own origin if it is left out. */
  readonly address?: string;
  /** A key on a server, a visitor's token in a browser; or what brings one, asked before each call. */
  readonly token?: string | (() => string | Promise<string>);
  readonly fetch?: typeof fetch;
}

export interface Sending {
  /** None, or one for each picture, white on the person: in place of the segmentation. */
  readonly masks?: readonly Blob[];
  /** How long the answer may wait for the fit's end, in seconds: 30 if it is left out, at most 60. */
  readonly wait?: number;
  /** The same key with the same content gives the same fit, however often it is sent. */
  readonly idempotencyKey?: string;
  readonly signal?: AbortSignal;
}

export interface Waiting {
  readonly onProgress?: (fit: Fit) => void;
  readonly signal?: AbortSignal;
}

/** The service refused a call, or a fit has no result. `problem` says which field, why, and what to do. */
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

  /** Send one to six pictures, in the order of the request's `views`. The fit may have ended already: `waitFor` it. */
  async fit(request: FitRequest, pictures: readonly Blob[], sending: Sending = {}): Promise<Fit> {
    const form = new FormData();
    form.append("request", new Blob([JSON.stringify(request)], { type: "application/json" }), "request.json");
    for (const picture of pictures) form.append("image", picture, "image");
    for (const mask of sending.masks ?? []) form.append("mask", mask, "mask");
    const headers: Record<string, string> = { Prefer: `wait=${sending.wait ?? DEFAULT_WAIT_S}` };
    if (sending.idempotencyKey !== undefined) headers["Idempotency-Key"] = sending.idempotencyKey;
    return json(await this.#call("/v1/fits", { method: "POST", body: form, headers, ...(sending.signal && { signal: sending.signal }) }));
  }

  /** Resolves once the fit has succeeded; rejects with a `MaquetteError` if it ended otherwise. */
  async waitFor(fit: Fit, { onProgress, signal }: Waiting = {}): Promise<Fit> {
    let seen = fit;
    for (;;) {
      onProgress?.(seen);
      if (seen.state === "succeeded") return seen;
      if (seen.state !== "queued" && seen.state !== "running") throw failure(seen.problem, 409, `The fit ended as ${seen.state}.`);
      await pause(POLL_MS, signal);
      seen = await json<Fit>(await this.#call(seen.links.self, signal ? { signal } : {}));
    }
  }

  /** What a fit that succeeded has found; `stages` is empty unless it is asked for. */
  async result(fit: Fit, asked: { readonly stages?: boolean } = {}): Promise<FitResult> {
    const query = asked.stages ? "?include=stages" : "";
    return json(await this.#call(`${fit.links.self}/result${query}`, {}));
  }

  /** One of its files: `views/0/overlay.png`, or, made when asked for, `body_canonical.obj`, `measurements.csv`. */
  async file(fit: Fit, name: string): Promise<Blob> {
    return (await this.#call(`${fit.links.self}/files/${name}`, {})).blob();
  }

  /** Stop it if it runs, and erase its pictures and results. */
  async erase(fit: Fit): Promise<void> {
    await this.#call(fit.links.self, { method: "DELETE" });
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
