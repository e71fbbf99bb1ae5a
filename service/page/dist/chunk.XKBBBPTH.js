import{A as G,C as L,d as f,e as M,g as x,i as y,j as b,k as w,m as P,v as g,w as A,y as S}from"/page/chunk.DKD75HTU.js";var k=.02,E=100;function F({fx:m,cx:r,cy:e,width:o,height:t},i){let l=Math.max(0,(t*i-o)/2),n=Math.max(0,(o/i-t)/2),s=u=>u/m*k;return new P().makePerspective(s(-r-l),s(o-r+l),s(e+n),s(e-t-n),k,E)}var R=.6,j=1.4,C=class{constructor(r,{upright:e}){this.fitted=r;e&&this.turned.fromArray(e)}fitted;camera=new L;origin=new w;turned=new b;began=null;isOver(r){return this.began!==null&&this.share(r)===1}at(r,e){this.began??=r;let o=this.share(r),{camera:t}=this;t.position.lerpVectors(this.origin,e.position,o),t.quaternion.slerpQuaternions(this.turned,e.quaternion,o);let i=F(this.fitted,e.aspect).elements;return t.projectionMatrix.fromArray(e.projectionMatrix.elements.map((l,n)=>i[n]+o*(l-i[n]))),t.projectionMatrixInverse.copy(t.projectionMatrix).invert(),t}share(r){let e=Math.min(1,Math.max(0,(r-this.began)/1e3-R)/j);return e*e*(3-2*e)}};var c=3.2,a=96,I=.08,h=2,U=`
  out vec2 vPlace;
  void main() {
    vPlace = uv;
    gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
  }
`,T=`
  precision highp float;
  in vec2 vPlace;
  uniform sampler2D near;
  uniform float side;
  uniform vec2 walked;
  out vec4 colour;
  void main() {
    vec2 metres = (vPlace - 0.5) * side;
    float fade = 1.0 - smoothstep(0.25, 1.0, length(metres) / (0.5 * side));
    vec2 cell = abs(fract((metres + walked) / 0.5 + 0.5) - 0.5) * 0.5;
    vec2 width = max(fwidth(metres), vec2(0.004));
    vec2 line = 1.0 - smoothstep(vec2(0.0), width, cell);
    float dark = texture(near, vec2(vPlace.x, 1.0 - vPlace.y)).r;
    float alpha = max(max(line.x, line.y) * 0.3 * fade, 0.1 * fade);
    colour = vec4(mix(vec3(0.5), vec3(0.0), dark), max(alpha, 0.5 * dark));
  }
`,V=class{mesh;near;constructor(){this.near=new A(new Uint8Array(a*a),a,a,M),this.near.minFilter=this.near.magFilter=f;let r=new G({glslVersion:x,vertexShader:U,fragmentShader:T,transparent:!0,depthWrite:!1,uniforms:{near:{value:this.near},side:{value:c},walked:{value:new y}}});this.mesh=new g(new S(c,c).rotateX(-Math.PI/2),r)}layUnder(r,e,o=r.reduce((t,{y:i})=>Math.min(t,i),1/0)){this.mesh.position.set(e.x,o,e.z);let t=new Float32Array(a*a);for(let{x:n,y:s,z:u}of r){let d=Math.floor(((n-e.x)/c+.5)*a),p=Math.floor(((u-e.z)/c+.5)*a);if(d<0||p<0||d>=a||p>=a)continue;let v=p*a+d;t[v]=Math.max(t[v],Math.exp((o-s)/I))}let i=this.near.image.data;_(_(t)).forEach((n,s)=>i[s]=Math.min(255,Math.round(255*n))),this.near.needsUpdate=!0}passUnder(r,e){this.mesh.material.uniforms.walked.value.set(r,-e)}dispose(){this.near.dispose(),this.mesh.geometry.dispose(),this.mesh.material.dispose()}};function _(m){return m.map((r,e)=>{let[o,t]=[Math.floor(e/a),e%a],[i,l]=[0,0];for(let n=Math.max(0,o-h);n<=Math.min(a-1,o+h);n++)for(let s=Math.max(0,t-h);s<=Math.min(a-1,t+h);s++)i+=m[n*a+s],l+=1;return i/l})}export{F as a,C as b,V as c};
