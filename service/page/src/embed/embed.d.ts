// The types of embed.js, and of the messages that a site and the page in its frame exchange. Version 1 of them
// gets new optional fields and messages at most: ignore those you do not know.

declare namespace Maquette {
  interface Subject {
    gender?: "female" | "male" | null;
    /** From 1.2 to 2.3. */
    height_m?: number | null;
    weight_kg?: number | null;
  }

  interface Pictures {
    front?: Blob | null;
    side?: Blob | null;
  }

  /** `system` is as the visitor's system has it. */
  type Theme = "light" | "dark" | "system";

  /** What a visitor may do with a result besides reading it. */
  type Deed = "save" | "delete";

  interface Options {
    /** Brings a new token from your server (POST /v1/tokens); called again when one has expired. */
    token?: () => Promise<string>;
    /** `en` or `de`, also with a region (`de-AT`); as the browser prefers if it is left out. */
    lang?: string;
    /** As the element's attribute `data-theme` has it if it is left out, or else `system`. */
    theme?: Theme;
    /** What you know of the visitor, who may change it. */
    subject?: Subject;
    pictures?: Pictures;
    /** What visitors may do with their result: files to save, and Delete, are shown if it says so. None is, without it. */
    allow?: readonly Deed[];
    /** What screen readers call the frame. */
    title?: string;
    /** Takes the frame away. */
    signal?: AbortSignal;
    onProgress?: (progress: Progress) => void;
    /** Called for each result: the visitor may measure again. */
    onResult?: (result: Result) => void;
  }

  interface Progress {
    stage: string;
    /** From 0 to 1. */
    share: number;
  }

  interface Measurement {
    name: string;
    value: number;
    unit: string;
    /** 95 of 100 such intervals hold the truth; null where that is not known. */
    low: number | null;
    high: number | null;
  }

  interface Result {
    scan_id: string;
    /** None where the verdict is not `plausible`, unless the visitor asked for them all the same. */
    measurements: Measurement[];
    verdict: "plausible" | "implausible" | "no_person";
    warnings: { code: string; message: string }[];
  }

  /** As the service explains it (RFC 9457). */
  interface Problem {
    code: string;
    status: number;
    title: string;
    detail: string;
    remedy: string;
  }

  /** Why there is no result. */
  interface Failure extends Error {
    /** `AbortError` when the visitor or your signal cancelled. */
    name: "AbortError" | "MaquetteError";
    /** Which option was refused. */
    field?: string;
    /** What the service answered. */
    problem?: Problem;
  }

  interface Start {
    type: "maquette:start";
    token?: string | null;
    lang?: string | null;
    theme?: Theme | null;
    subject?: Subject | null;
    pictures?: Pictures | null;
    allow?: readonly Deed[] | null;
  }

  type ToFrame = Start | { type: "maquette:token"; token: string } | { type: "maquette:theme"; theme: Theme };

  type FromFrame =
    | { type: "maquette:ready"; version: 1 }
    | { type: "maquette:refused"; field: string; reason: string }
    | { type: "maquette:token-needed" }
    | { type: "maquette:resize"; height: number }
    /** The camera wants the whole window while it is open. */
    | { type: "maquette:camera"; open: boolean }
    | ({ type: "maquette:progress" } & Progress)
    | ({ type: "maquette:result" } & Result)
    | { type: "maquette:failed"; problem: Problem }
    | { type: "maquette:cancelled" };

  /** Show the page in an element, whose attribute `data-theme` it follows. Resolves with the first result; rejects with a `Failure`. The frame stays. */
  function measure(element: HTMLElement, options?: Options): Promise<Result>;
}
