// The calls this page makes, one function each.
import { jsonBody, request, requestJson } from "./client";
import type { CaptureCheck, CheckOfImage, Derivation, DerivationPage, DerivationRequest, DerivationResult, FitOfImage, FitOptions, FitResult, InitialPose, InitialPoseRequest, Job, PointsOfImage, PointsProposal, Scan, ScanOfImages, ScanOptions, ScanResult, UploadedImage } from "./types";

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

export function submitScan(asked: ScanOfImages): Promise<Scan> {
  return requestJson("/v1/scans", jsonBody(asked));
}

export function getScan(id: string): Promise<Scan> {
  return requestJson(`/v1/scans/${id}`);
}

export function getScanResult({ links }: Scan): Promise<ScanResult> {
  return requestJson(links.result ?? `${links.self}/result`);
}

export function getScanRequest({ links }: Scan): Promise<ScanOptions> {
  return requestJson(links.request);
}

export function cancelScan(id: string): Promise<Scan> {
  return requestJson(`/v1/scans/${id}/cancel`, { method: "POST" });
}

export async function eraseScan(id: string): Promise<void> {
  await request(`/v1/scans/${id}`, { method: "DELETE" });
}

export function submitFit(asked: FitOfImage): Promise<Job> {
  return requestJson("/v1/fits", jsonBody(asked));
}

export function getFit(id: string): Promise<Job> {
  return requestJson(`/v1/fits/${id}`);
}

export function getResult(job: Job): Promise<FitResult> {
  return requestJson(job.links.result ?? `/v1/fits/${job.id}/result`);
}

export function getRequest(job: Job): Promise<FitOptions> {
  return requestJson(job.links.request);
}

export function cancelFit(id: string): Promise<Job> {
  return requestJson(`/v1/fits/${id}/cancel`, { method: "POST" });
}

export async function eraseFit(id: string): Promise<void> {
  await request(`/v1/fits/${id}`, { method: "DELETE" });
}

export async function listDerivations(fit: Job): Promise<readonly Derivation[]> {
  return (await requestJson<DerivationPage>(`/v1/fits/${fit.id}/derivations`)).derivations;
}

/** Ask for a derivation; `part` is the file it goes by, under the name of its form part. */
export function derive(fit: Job, asked: DerivationRequest, part: { name: string; file: File } | null): Promise<Derivation> {
  const path = `/v1/fits/${fit.id}/derivations`;
  if (!part) return requestJson(path, jsonBody(asked));
  const form = new FormData();
  form.append("request", new Blob([JSON.stringify(asked)], { type: "application/json" }), "request.json");
  form.append(part.name, part.file, part.file.name);
  return requestJson(path, { method: "POST", body: form });
}

export function getDerivation(path: string): Promise<Derivation> {
  return requestJson(path);
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

/** A file by its link: by fetch, not by an element's address, since a key may be needed. */
export async function getFile(path: string): Promise<Blob> {
  return (await request(path)).blob();
}
