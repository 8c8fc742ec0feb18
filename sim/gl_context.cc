#include "sim/gl_context.h"

#include <GL/osmesa.h>
// osmesa.h brings OpenGL 1.x; this brings the types of all later functions.
#include <GL/glext.h>

#include <cstdlib>
#include <stdexcept>

namespace plumbline {
namespace {

constexpr char kUnavailable[] = "OSMesa gives no OpenGL 4.5 core context";

struct AnyFunction {
  OSMESAproc address = nullptr;
  template <typename Function>
  operator Function() const {
    return reinterpret_cast<Function>(address);
  }
};

AnyFunction load(const char* name) {
  const OSMESAproc address = OSMesaGetProcAddress(name);
  if (address == nullptr) throw std::runtime_error(std::string("OSMesa lacks the OpenGL function ") + name);
  return {address};
}

/// Everything comes from OSMesa itself: the process may also hold a system libGL, whose functions know no such context.
struct Functions {
  PFNGLCREATESHADERPROC CreateShader = load("glCreateShader");
  PFNGLSHADERSOURCEPROC ShaderSource = load("glShaderSource");
  PFNGLCOMPILESHADERPROC CompileShader = load("glCompileShader");
  PFNGLGETSHADERIVPROC GetShaderiv = load("glGetShaderiv");
  PFNGLGETSHADERINFOLOGPROC GetShaderInfoLog = load("glGetShaderInfoLog");
  PFNGLDELETESHADERPROC DeleteShader = load("glDeleteShader");
  PFNGLCREATEPROGRAMPROC CreateProgram = load("glCreateProgram");
  PFNGLATTACHSHADERPROC AttachShader = load("glAttachShader");
  PFNGLLINKPROGRAMPROC LinkProgram = load("glLinkProgram");
  PFNGLGETPROGRAMIVPROC GetProgramiv = load("glGetProgramiv");
  PFNGLGETPROGRAMINFOLOGPROC GetProgramInfoLog = load("glGetProgramInfoLog");
  PFNGLUSEPROGRAMPROC UseProgram = load("glUseProgram");
  PFNGLGETUNIFORMLOCATIONPROC GetUniformLocation = load("glGetUniformLocation");
  PFNGLUNIFORM1FPROC Uniform1f = load("glUniform1f");
  PFNGLUNIFORMMATRIX4FVPROC UniformMatrix4fv = load("glUniformMatrix4fv");
  PFNGLGENVERTEXARRAYSPROC GenVertexArrays = load("glGenVertexArrays");
  PFNGLBINDVERTEXARRAYPROC BindVertexArray = load("glBindVertexArray");
  PFNGLGENBUFFERSPROC GenBuffers = load("glGenBuffers");
  PFNGLBINDBUFFERPROC BindBuffer = load("glBindBuffer");
  PFNGLBUFFERDATAPROC BufferData = load("glBufferData");
  PFNGLENABLEVERTEXATTRIBARRAYPROC EnableVertexAttribArray = load("glEnableVertexAttribArray");
  PFNGLVERTEXATTRIBPOINTERPROC VertexAttribPointer = load("glVertexAttribPointer");
  PFNGLACTIVETEXTUREPROC ActiveTexture = load("glActiveTexture");
  PFNGLTEXSTORAGE2DPROC TexStorage2D = load("glTexStorage2D");
  PFNGLTEXSTORAGE3DPROC TexStorage3D = load("glTexStorage3D");
  PFNGLTEXSUBIMAGE3DPROC TexSubImage3D = load("glTexSubImage3D");
  decltype(&::glTexSubImage2D) TexSubImage2D = load("glTexSubImage2D");
  PFNGLGENFRAMEBUFFERSPROC GenFramebuffers = load("glGenFramebuffers");
  PFNGLBINDFRAMEBUFFERPROC BindFramebuffer = load("glBindFramebuffer");
  PFNGLGENRENDERBUFFERSPROC GenRenderbuffers = load("glGenRenderbuffers");
  PFNGLBINDRENDERBUFFERPROC BindRenderbuffer = load("glBindRenderbuffer");
  PFNGLRENDERBUFFERSTORAGEPROC RenderbufferStorage = load("glRenderbufferStorage");
  PFNGLFRAMEBUFFERRENDERBUFFERPROC FramebufferRenderbuffer = load("glFramebufferRenderbuffer");
  PFNGLCHECKFRAMEBUFFERSTATUSPROC CheckFramebufferStatus = load("glCheckFramebufferStatus");
  PFNGLCLIPCONTROLPROC ClipControl = load("glClipControl");
  PFNGLCLEARBUFFERFVPROC ClearBufferfv = load("glClearBufferfv");
  decltype(&::glGenTextures) GenTextures = load("glGenTextures");
  decltype(&::glBindTexture) BindTexture = load("glBindTexture");
  decltype(&::glTexParameteri) TexParameteri = load("glTexParameteri");
  decltype(&::glPixelStorei) PixelStorei = load("glPixelStorei");
  decltype(&::glViewport) Viewport = load("glViewport");
  decltype(&::glEnable) Enable = load("glEnable");
  decltype(&::glFrontFace) FrontFace = load("glFrontFace");
  decltype(&::glDepthFunc) DepthFunc = load("glDepthFunc");
  decltype(&::glDrawElements) DrawElements = load("glDrawElements");
  decltype(&::glFlush) Flush = load("glFlush");
  decltype(&::glReadPixels) ReadPixels = load("glReadPixels");
  decltype(&::glGetError) GetError = load("glGetError");
};

OSMesaContext create_context(int threads) {
  setenv("LP_NUM_THREADS", std::to_string(threads).c_str(), 1);
  const int attributes[] = {OSMESA_FORMAT,
                            OSMESA_RGBA,
                            OSMESA_DEPTH_BITS,
                            0,
                            OSMESA_PROFILE,
                            OSMESA_CORE_PROFILE,
                            OSMESA_CONTEXT_MAJOR_VERSION,
                            4,
                            OSMESA_CONTEXT_MINOR_VERSION,
                            5,
                            0};
  OSMesaContext context = OSMesaCreateContextAttribs(attributes, nullptr);
  if (context == nullptr) throw std::runtime_error(kUnavailable);
  return context;
}

}  // namespace

struct GlContext::Impl {
  Impl(int frame_width, int frame_height, int threads)
      : width(frame_width), height(frame_height), context(create_context(threads)) {}
  ~Impl() { OSMesaDestroyContext(context); }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  void make_current();
  void make_framebuffer();
  GLuint compile(GLenum kind, const std::string& source);

  int width;
  int height;
  OSMesaContext context;
  Functions gl;
  // OSMesa insists on a window of its own; nothing is drawn there.
  std::array<std::uint8_t, 4 * 4 * 4> window{};
};

void GlContext::Impl::make_current() {
  if (OSMesaGetCurrentContext() == context) return;
  if (OSMesaMakeCurrent(context, window.data(), GL_UNSIGNED_BYTE, 4, 4) != GL_TRUE) {
    throw std::runtime_error(kUnavailable);
  }
}

void GlContext::Impl::make_framebuffer() {
  GLuint framebuffer = 0;
  GLuint buffers[2] = {};
  gl.GenFramebuffers(1, &framebuffer);
  gl.GenRenderbuffers(2, buffers);
  gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  gl.BindRenderbuffer(GL_RENDERBUFFER, buffers[0]);
  gl.RenderbufferStorage(GL_RENDERBUFFER, GL_R32F, width, height);
  gl.FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, buffers[0]);
  gl.BindRenderbuffer(GL_RENDERBUFFER, buffers[1]);
  gl.RenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT32F, width, height);
  gl.FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, buffers[1]);
  if (gl.CheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) throw std::runtime_error(kUnavailable);
  gl.Viewport(0, 0, width, height);
  gl.ClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
  gl.Enable(GL_DEPTH_TEST);
  gl.DepthFunc(GL_GREATER);
  gl.Enable(GL_CULL_FACE);
  // Images keep their top row first in memory, where OpenGL has its bottom row: the picture is mirrored, and so is
  // the winding.
  gl.FrontFace(GL_CW);
  gl.PixelStorei(GL_UNPACK_ALIGNMENT, 1);
}

GLuint GlContext::Impl::compile(GLenum kind, const std::string& source) {
  const GLuint shader = gl.CreateShader(kind);
  const GLchar* text = source.c_str();
  gl.ShaderSource(shader, 1, &text, nullptr);
  gl.CompileShader(shader);
  GLint compiled = GL_FALSE;
  gl.GetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
  if (compiled != GL_TRUE) {
    GLchar log[1024] = "";
    gl.GetShaderInfoLog(shader, sizeof log, nullptr, log);
    throw std::runtime_error(std::string("a shader does not compile: ") + log);
  }
  return shader;
}

GlContext::GlContext(int width, int height, int threads) : impl_(std::make_unique<Impl>(width, height, threads)) {
  impl_->make_current();
  impl_->make_framebuffer();
}

GlContext::~GlContext() = default;

void GlContext::make_current() { impl_->make_current(); }

GlContext::Program GlContext::make_program(const std::string& vertex_shader, const std::string& fragment_shader) {
  const Functions& gl = impl_->gl;
  Program program;
  program.handle = gl.CreateProgram();
  for (const GLuint shader :
       {impl_->compile(GL_VERTEX_SHADER, vertex_shader), impl_->compile(GL_FRAGMENT_SHADER, fragment_shader)}) {
    gl.AttachShader(program.handle, shader);
    gl.DeleteShader(shader);
  }
  gl.LinkProgram(program.handle);
  GLint linked = GL_FALSE;
  gl.GetProgramiv(program.handle, GL_LINK_STATUS, &linked);
  if (linked != GL_TRUE) {
    GLchar log[1024] = "";
    gl.GetProgramInfoLog(program.handle, sizeof log, nullptr, log);
    throw std::runtime_error(std::string("a shader program does not link: ") + log);
  }
  program.matrix = gl.GetUniformLocation(program.handle, "clip_from_chunk");
  program.light = gl.GetUniformLocation(program.handle, "light_factor");
  return program;
}

std::uint32_t GlContext::make_mesh(std::span<const float> vertices, std::span<const int> attribute_sizes,
                                   std::span<const std::uint32_t> indices) {
  const Functions& gl = impl_->gl;
  GLuint mesh = 0;
  GLuint buffers[2] = {};
  gl.GenVertexArrays(1, &mesh);
  gl.BindVertexArray(mesh);
  gl.GenBuffers(2, buffers);
  gl.BindBuffer(GL_ARRAY_BUFFER, buffers[0]);
  gl.BufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(vertices.size_bytes()), vertices.data(), GL_STATIC_DRAW);
  gl.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffers[1]);
  gl.BufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(indices.size_bytes()), indices.data(), GL_STATIC_DRAW);
  int components = 0;
  for (const int size : attribute_sizes) components += size;
  std::uintptr_t offset = 0;
  for (std::size_t i = 0; i < attribute_sizes.size(); ++i) {
    gl.EnableVertexAttribArray(static_cast<GLuint>(i));
    gl.VertexAttribPointer(static_cast<GLuint>(i), attribute_sizes[i], GL_FLOAT, GL_FALSE,
                           components * static_cast<GLsizei>(sizeof(float)), reinterpret_cast<const void*>(offset));
    offset += static_cast<std::uintptr_t>(attribute_sizes[i]) * sizeof(float);
  }
  return mesh;
}

void GlContext::make_texture_array(int unit, int size, std::span<const std::vector<std::vector<float>>* const> layers) {
  const Functions& gl = impl_->gl;
  const auto level_count = static_cast<GLsizei>(layers.front()->size());
  GLuint texture = 0;
  gl.GenTextures(1, &texture);
  gl.ActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
  gl.BindTexture(GL_TEXTURE_2D_ARRAY, texture);
  gl.TexStorage3D(GL_TEXTURE_2D_ARRAY, level_count, GL_R32F, size, size, static_cast<GLsizei>(layers.size()));
  gl.TexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  gl.TexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  for (std::size_t layer = 0; layer < layers.size(); ++layer) {
    for (GLint level = 0; level < level_count; ++level) {
      gl.TexSubImage3D(GL_TEXTURE_2D_ARRAY, level, 0, 0, static_cast<GLint>(layer), size >> level, size >> level, 1,
                       GL_RED, GL_FLOAT, (*layers[layer])[static_cast<std::size_t>(level)].data());
    }
  }
  if (gl.GetError() != GL_NO_ERROR) throw std::runtime_error("OpenGL does not take the world's textures");
}

void GlContext::make_texture(int unit, int width, int height, std::span<const float> texels) {
  const Functions& gl = impl_->gl;
  GLuint texture = 0;
  gl.GenTextures(1, &texture);
  gl.ActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
  gl.BindTexture(GL_TEXTURE_2D, texture);
  gl.TexStorage2D(GL_TEXTURE_2D, 1, GL_R32F, width, height);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  gl.TexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, width, height, GL_RED, GL_FLOAT, texels.data());
  if (gl.GetError() != GL_NO_ERROR) throw std::runtime_error("OpenGL does not take the world's light map");
}

void GlContext::flush() { impl_->gl.Flush(); }

void GlContext::clear(float luminance) {
  const GLfloat colour[4] = {luminance, 0.0F, 0.0F, 1.0F};
  const GLfloat farthest = 0.0F;
  impl_->gl.ClearBufferfv(GL_COLOR, 0, colour);
  impl_->gl.ClearBufferfv(GL_DEPTH, 0, &farthest);
}

void GlContext::use(const Program& program, float light_factor) {
  impl_->gl.UseProgram(program.handle);
  impl_->gl.Uniform1f(program.light, light_factor);
}

void GlContext::draw(const Program& program, std::uint32_t mesh, int index_count, const Matrix& clip_from_chunk) {
  impl_->gl.UniformMatrix4fv(program.matrix, 1, GL_FALSE, clip_from_chunk.data());
  impl_->gl.BindVertexArray(mesh);
  impl_->gl.DrawElements(GL_TRIANGLES, index_count, GL_UNSIGNED_INT, nullptr);
}

void GlContext::read_luminance(std::vector<float>& out) {
  out.resize(static_cast<std::size_t>(impl_->width) * static_cast<std::size_t>(impl_->height));
  impl_->gl.ReadPixels(0, 0, impl_->width, impl_->height, GL_RED, GL_FLOAT, out.data());
}

void GlContext::read_depth(std::vector<float>& out) {
  out.resize(static_cast<std::size_t>(impl_->width) * static_cast<std::size_t>(impl_->height));
  impl_->gl.ReadPixels(0, 0, impl_->width, impl_->height, GL_DEPTH_COMPONENT, GL_FLOAT, out.data());
}

}  // namespace plumbline
