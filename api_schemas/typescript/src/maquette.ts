// Maquette's HTTP API for browsers and Node: `fit` pictures, take `result` and `file`s, have a `product` made.
// All types are those of openapi.json.
import type { components } from "./schema.js";

export type Schemas = components["schemas"];
export type Fit = Schemas["Fit"];
export type FitRequest = Schemas["FitRequest"];
export type FitResult = Schemas["FitResult"];
export type Measurement = Schemas["Measurement"];
export type Problem = Schemas["Problem"];
export type Product = Schemas["Product"];
export type ProductRequest = Schemas["ProductRequest"];
export type Progress = Schemas["EventData"];

export interface Options {
  /** Where the service is, `https://measure.example.org`; in a browser the page's own origin if it is left out. */
  readonly address?: string;
  /** An API key, where the service asks for one: on a server, never in a browser. */
  readonly key?: string;
  readonly fetch?: typeof fetch;
}

export interface Sending {
  /** None, or one for each picture, white on the person: in place of the segmentation. */
  readonly masks?: readonly Blob[];
  /** The same key with the same content gives the same fit, however often it is sent. */
  readonly idempotencyKey?: string;
  readonly onProgress?: (progress: Progress) => void;
  readonly signal?: AbortSignal;
}

/** The service refused a call, or a fit or product failed. `problem` says which field, why, and what to do. */
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

const PAUSE_S = 1;
const PROBLEM = "application/problem+json";

export class Maquette {
  readonly #address: string;
  readonly #key: string | undefined;
  readonly #fetch: typeof fetch;

  constructor(options: Options = {}) {
    this.#address = (options.address ?? "").replace(/\/$/, "");
    this.#key = options.key;
    this.#fetch = options.fetch ?? globalThis.fetch.bind(globalThis);
  }

  /** Have one to six pictures fitted, in the order of the request's `views`; resolves once that has succeeded. */
  async fit(request: FitRequest, pictures: readonly Blob[], sending: Sending = {}): Promise<Fit> {
    const form = formWith(request);
    for (const picture of pictures) form.append("image", picture, "image");
    for (const mask of sending.masks ?? []) form.append("mask", mask, "mask");
    const headers: Record<string, string> = {};
    if (sending.idempotencyKey !== undefined) headers["Idempotency-Key"] = sending.idempotencyKey;
    const init = sending.signal ? { signal: sending.signal } : {};
    const fit = await json<Fit>(await this.#call("/v1/fits", { method: "POST", body: form, headers, ...init }));
    await this.#follow(fit, sending);
    return succeeded(await json<Fit>(await this.#call(fit.links.self, init)));
  }

  /** What a fit has found. */
  async result(fit: Fit): Promise<FitResult> {
    return json(await this.#call(`${fit.links.self}/result`));
  }

  /** Have something made of a fit; `part` is what comes along, `{ bvh }` or `{ chart }`. */
  async product(
    fit: Fit,
    request: ProductRequest,
    part: Readonly<Record<string, Blob>> = {},
    onProgress?: (product: Product) => void,
  ): Promise<Product> {
    const form = formWith(request);
    for (const [name, content] of Object.entries(part)) form.append(name, content, name);
    const headers = { Prefer: `wait=${PAUSE_S}` };
    let product = await json<Product>(await this.#call(`${fit.links.self}/products`, { method: "POST", body: form, headers }));
    while (product.state === "queued" || product.state === "running") {
      onProgress?.(product);
      await pause();
      product = await json<Product>(await this.#call(product.links.self));
    }
    return succeeded(product);
  }

  /** A file of a fit or a product: `views/0/overlay.png`, or, made when asked for, `body_canonical.obj`. */
  async file(of: Fit | Product, name: string): Promise<Blob> {
    return (await this.#call(`${of.links.self}/files/${name}`)).blob();
  }

  /** Erase a fit with its pictures, results and products. */
  async erase(fit: Fit): Promise<void> {
    await this.#call(fit.links.self, { method: "DELETE" });
  }

  /** Read a fit's events to their end, over broken connections too. */
  async #follow(fit: Fit, { onProgress, signal }: Sending): Promise<void> {
    let seen = "0";
    for (;;) {
      signal?.throwIfAborted();
      try {
        const init = { headers: { "Last-Event-ID": seen }, ...(signal && { signal }) };
        const response = await this.#call(fit.links.events, init);
        if (response.status === 204) return;
        for await (const event of events(response)) {
          seen = event["id"] ?? seen;
          onProgress?.(JSON.parse(event["data"] ?? "{}") as Progress);
          if (event["event"] === "end") return;
        }
      } catch (error) {
        if (signal?.aborted || (error instanceof MaquetteError && error.status < 500)) throw error;
      }
      await pause();
    }
  }

  async #call(path: string, init: RequestInit = {}): Promise<Response> {
    const headers = new Headers(init.headers);
    if (this.#key !== undefined) headers.set("Authorization", `Bearer ${this.#key}`);
    const response = await this.#fetch(this.#address + path, { ...init, headers });
    if (response.ok) return response;
    const isProblem = response.headers.get("Content-Type")?.startsWith(PROBLEM);
    throw failure(isProblem ? await json<Problem>(response) : null, response.status, `The service answered ${response.status}.`);
  }
}

/** The fields of each event of a stream. */
async function* events(response: Response): AsyncGenerator<Record<string, string>> {
  const reader = response.body!.pipeThrough(new TextDecoderStream()).getReader();
  let text = "";
  for (;;) {
    const { done, value } = await reader.read();
    if (done) return;
    const whole = (text + value).split("\n\n");
    text = whole.pop()!;
    for (const event of whole) {
      const fields = event.split("\n").filter((line) => !line.startsWith(":"));
      if (fields.length > 0) yield Object.fromEntries(fields.map((line) => line.split(/: (.*)/s, 2)));
    }
  }
}

function formWith(request: FitRequest | ProductRequest): FormData {
  const form = new FormData();
  form.append("request", new Blob([JSON.stringify(request)], { type: "application/json" }), "request.json");
  return form;
}

function succeeded<Ended extends Fit | Product>(ended: Ended): Ended {
  if (ended.state === "succeeded") return ended;
  throw failure(ended.problem, 409, `It ended as ${ended.state}.`);
}

function failure(problem: Problem | null, status: number, otherwise: string): MaquetteError {
  const message = problem ? `${problem.detail} ${problem.remedy}`.trim() : otherwise;
  return new MaquetteError(message, problem?.status ?? status, problem);
}

async function json<T>(response: Response): Promise<T> {
  return (await response.json()) as T;
}

async function pause(): Promise<void> {
  await new Promise((resume) => setTimeout(resume, 1_000 * PAUSE_S));
}
