// The calls this page makes, one function each.
import type { ServiceIndex } from "./service_index";
import { jsonBody, request, requestJson } from "./client";
import { askedOfFit, fitOfJob, fitOfScan, pathOf, resultOfFit, resultOfScan } from "./fits";
import type { Asked, Fit, FitKind, FitRef, Result } from "./fits";
import type { CaptureCheck, CheckOfImage, Derivation, DerivationPage, DerivationRequest, DerivationResult, FitOfImage, FitOptions, FitResult, InitialPose, InitialPoseRequest, Job, PointsOfImage, PointsProposal, Scan, ScanOfImages, ScanResult, UploadedImage } from "./types";

export function getIndex(): Promise<ServiceIndex> {
  return requestJson("/", { headers: { Accept: "application/json" } });
}

export function uploadImage(file: Blob, signal: AbortSignal): Promise<UploadedImage> {
  const form = new FormData();
  form.append("image", file, "picture");
  return requestJson("/v1/images", { method: "POST", body: form, signal });
}

export function initialPose(asked: InitialPoseRequest, signal: AbortSignal): Promise<InitialPose> {
  return requestJson("/v1/initial-poses", { ...jsonBody(asked), signal });
}

export function proposePoints(asked: PointsOfImage, signal: AbortSignal): Promise<PointsProposal> {
  return requestJson("/v1/points", { ...jsonBody(asked), signal });
}

export function checkCapture(asked: CheckOfImage, signal: AbortSignal): Promise<CaptureCheck> {
  return requestJson("/v1/checks", { ...jsonBody(asked), signal });
}

export async function submitFit(asked: FitOfImage): Promise<Fit> {
  return fitOfJob(await requestJson("/v1/fits", jsonBody(asked)));
}

export async function submitScan(asked: ScanOfImages): Promise<Fit> {
  return fitOfScan(await requestJson("/v1/scans", jsonBody(asked)));
}

export async function getFit(which: FitRef): Promise<Fit> {
  return fitOf(which.kind, await requestJson(pathOf(which)));
}

export async function cancelFit(which: FitRef): Promise<Fit> {
  return fitOf(which.kind, await requestJson(`${pathOf(which)}/cancel`, { method: "POST" }));
}

export async function eraseFit(which: FitRef): Promise<void> {
  await request(pathOf(which), { method: "DELETE" });
}

export async function getResult({ kind, links }: Fit): Promise<Result> {
  const found = await requestJson<FitResult | ScanResult>(`${links.result ?? `${links.self}/result`}?include=stages`);
  return kind === "fit" ? resultOfFit(found as FitResult) : resultOfScan(found as ScanResult);
}

export async function getAsked({ kind, links }: Fit): Promise<Asked> {
  const asked = await requestJson<FitOptions | Asked>(links.request);
  return kind === "fit" ? askedOfFit(asked as FitOptions) : (asked as Asked);
}

function fitOf(kind: FitKind, told: Job | Scan): Fit {
  return kind === "fit" ? fitOfJob(told as Job) : fitOfScan(told as Scan);
}

/** All of them, newest first. */
export async function listDerivations({ links }: Fit): Promise<readonly Derivation[]> {
  const list: Derivation[] = [];
  for (let path: string | null = `${links.self}/derivations`; path; ) {
    const page: DerivationPage = await requestJson(path);
    list.push(...page.derivations);
    path = page.next;
  }
  return list;
}

/** Ask for a derivation; `part` is the file it goes by, under the name of its form part. */
export function derive({ links }: Fit, asked: DerivationRequest, part: { name: string; file: File } | null): Promise<Derivation> {
  const path = `${links.self}/derivations`;
  if (!part) return requestJson(path, jsonBody(asked));
  const form = new FormData();
  form.append("request", new Blob([JSON.stringify(asked)], { type: "application/json" }), "request.json");
  form.append(part.name, part.file, part.file.name);
  return requestJson(path, { method: "POST", body: form });
}

export function getDerivation(path: string): Promise<Derivation> {
  return requestJson(path);
}

/** What was asked for. */
export function getAskedDerivation({ links }: Derivation): Promise<DerivationRequest> {
  return requestJson(links.request);
}

export function getDerivationResult({ links }: Derivation): Promise<DerivationResult> {
  return requestJson(links.result ?? `${links.self}/result`);
}

export function retryDerivation({ links }: Derivation): Promise<Derivation> {
  return requestJson(`${links.self}/retry`, { method: "POST" });
}

export async function eraseDerivation({ links }: Derivation): Promise<void> {
  await request(links.self, { method: "DELETE" });
}

/** The picture of a fit or a scan as every browser shows it: a HEIC comes as a JPEG. */
export async function getPicture(path: string): Promise<Blob> {
  return (await request(path, { headers: { Accept: "image/png, image/webp, image/jpeg" } })).blob();
}

/** A file by its link: by fetch, not by an element's address, since a key may be needed. `onBytes` hears of each piece. */
export async function getFile(path: string, onBytes?: (count: number) => void): Promise<Blob> {
  const response = await request(path);
  if (!onBytes || !response.body) return response.blob();
  const pieces: Uint8Array<ArrayBuffer>[] = [];
  const reader = response.body.getReader();
  for (let piece = await reader.read(); !piece.done; piece = await reader.read()) {
    pieces.push(piece.value);
    onBytes(piece.value.length);
  }
  return new Blob(pieces, { type: response.headers.get("Content-Type") ?? "" });
}
