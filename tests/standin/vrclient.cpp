// A stand-in for an OpenVR runtime: plays a scene, a text file, in real time.
//
// The OpenVR loader finds it by a path registry, loads bin/linux64/vrclient.so and asks
// VRClientCoreFactory for IVRClientCore_003, which hands out the function table of
// IVRSystem_023. Layouts follow openvr.h and openvr_capi.h of OpenVR 2.12
// (https://github.com/ValveSoftware/openvr/tree/master/headers).
//
// The scene is named by SMD_STANDIN_SCENE, and a log of what was asked by SMD_STANDIN_LOG:
//
//   refuse NUMBER                                   Init returns this EVRInitError
//   quit SECONDS                                    the runtime quits then
//   device INDEX CLASS ROLE SERIAL MODEL BATTERY    BATTERY -1: not known
//   row SECONDS INDEX x y z qx qy qz qw CONNECTED VALID RESULT BUTTONS
//
// Times count from the first time that poses are asked for. Poses are interpolated between rows;
// what else a row says holds until the next row.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace {

constexpr int kMostDevices = 64;
constexpr int kNone = 0;
constexpr int kInterfaceNotFound = 105;
constexpr int kInvalidDevice = 5, kUnknownProperty = 4, kBufferTooSmall = 3;
constexpr int kModel = 1001, kSerial = 1002, kBattery = 1012;
constexpr uint32_t kQuit = 700;

struct Row {
  double time_s;
  double position[3], quaternion[4];
  int connected, valid, result;
  unsigned long long buttons;
};

struct Device {
  int kind = 0, role = 0;
  std::string serial, model;
  float battery = -1.0f;
  std::vector<Row> rows;
};

struct Pose {  // TrackedDevicePose_t
  float matrix[3][4];
  float velocity[3], angular_velocity[3];
  int32_t result;
  bool valid, connected;
};
static_assert(sizeof(Pose) == 80, "as in openvr.h");

#pragma pack(push, 4)  // as openvr.h does on Linux and macOS
struct ControllerState {
  uint32_t packet;
  uint64_t pressed, touched;
  float axis[5][2];
};
struct Event {
  uint32_t type, device;
  float age_s;
};
#pragma pack(pop)

struct Scene {
  Device devices[kMostDevices];
  int refuse = kNone;
  double quit_s = INFINITY;
  bool quit_told = false;
  double start_s = -1.0;
  FILE* log = nullptr;
};

Scene scene;

double clock_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

void log_line(const char* word, double number) {
  if (scene.log) std::fprintf(scene.log, "%s %.9f\n", word, number);
}

double scene_s() {
  const double now_s = clock_s();
  if (scene.start_s < 0.0) {
    scene.start_s = now_s;
    log_line("start", now_s);
  }
  return now_s - scene.start_s;
}

void read_scene() {
  if (scene.log) std::fclose(scene.log);
  scene = Scene();
  if (const char* path = std::getenv("SMD_STANDIN_LOG")) scene.log = std::fopen(path, "w");
  if (scene.log) std::setvbuf(scene.log, nullptr, _IOLBF, BUFSIZ);  // true after kill -9, too
  const char* path = std::getenv("SMD_STANDIN_SCENE");
  std::ifstream file(path ? path : "");
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    std::string word;
    words >> word;
    if (word == "refuse") {
      words >> scene.refuse;
    } else if (word == "quit") {
      words >> scene.quit_s;
    } else if (word == "device") {
      int index;
      words >> index;
      Device& device = scene.devices[index];
      words >> device.kind >> device.role >> device.serial >> device.model >> device.battery;
    } else if (word == "row") {
      int index;
      Row row;
      words >> row.time_s >> index;
      for (double& value : row.position) words >> value;
      for (double& value : row.quaternion) words >> value;
      words >> row.connected >> row.valid >> row.result >> row.buttons;
      scene.devices[index].rows.push_back(row);
    }
  }
}

const Row* row_before(const Device& device, double time_s) {
  if (device.rows.empty()) return nullptr;
  auto after = std::upper_bound(device.rows.begin(), device.rows.end(), time_s,
                                [](double t, const Row& row) { return t < row.time_s; });
  return &*(after == device.rows.begin() ? after : after - 1);
}

Row row_at(const Device& device, double time_s) {
  const Row* before = row_before(device, time_s);
  Row row = *before;
  const Row* after = before + 1;
  if (after == device.rows.data() + device.rows.size() || time_s <= before->time_s) return row;
  const double u = (time_s - before->time_s) / (after->time_s - before->time_s);
  for (int i = 0; i < 3; i++) row.position[i] += u * (after->position[i] - before->position[i]);
  double dot = 0.0;
  for (int i = 0; i < 4; i++) dot += before->quaternion[i] * after->quaternion[i];
  const double sign = dot < 0.0 ? -1.0 : 1.0;
  const double angle = std::acos(std::min(1.0, std::abs(dot)));
  const double a = angle < 1e-9 ? 1.0 - u : std::sin((1.0 - u) * angle) / std::sin(angle);
  const double b = angle < 1e-9 ? u : std::sin(u * angle) / std::sin(angle);
  for (int i = 0; i < 4; i++)
    row.quaternion[i] = a * before->quaternion[i] + sign * b * after->quaternion[i];
  return row;
}

void fill(Pose& pose, const Row& row) {
  const double x = row.quaternion[0], y = row.quaternion[1], z = row.quaternion[2],
               w = row.quaternion[3];
  const double turn[3][3] = {
      {1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)},
      {2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)},
      {2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)}};
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++) pose.matrix[i][j] = static_cast<float>(turn[i][j]);
    pose.matrix[i][3] = static_cast<float>(row.position[i]);
  }
  pose.result = row.result;
  pose.valid = row.valid != 0;
  pose.connected = row.connected != 0;
}

void get_poses(int, float, Pose* poses, uint32_t count) {
  const double time_s = scene_s();
  log_line("poses", time_s);
  for (uint32_t i = 0; i < count; i++) {
    poses[i] = Pose();
    if (i < kMostDevices && !scene.devices[i].rows.empty())
      fill(poses[i], row_at(scene.devices[i], time_s));
  }
}

int get_role(uint32_t index) { return index < kMostDevices ? scene.devices[index].role : 0; }

int get_class(uint32_t index) { return index < kMostDevices ? scene.devices[index].kind : 0; }

bool is_connected(uint32_t index) {
  const Row* row = index < kMostDevices ? row_before(scene.devices[index], scene_s()) : nullptr;
  return row && row->connected;
}

float get_float(uint32_t index, int what, int* error) {
  const bool known = index < kMostDevices && scene.devices[index].kind && what == kBattery &&
                     scene.devices[index].battery >= 0.0f;
  *error = known ? kNone : kUnknownProperty;
  return known ? scene.devices[index].battery : 0.0f;
}

uint32_t get_string(uint32_t index, int what, char* value, uint32_t size, int* error) {
  if (index >= kMostDevices || !scene.devices[index].kind) {
    *error = kInvalidDevice;
    return 0;
  }
  if (what != kSerial && what != kModel) {
    *error = kUnknownProperty;
    return 0;
  }
  const Device& device = scene.devices[index];
  const std::string& text = what == kSerial ? device.serial : device.model;
  const uint32_t needed = static_cast<uint32_t>(text.size()) + 1;
  *error = size < needed ? kBufferTooSmall : kNone;
  if (size >= needed) std::memcpy(value, text.c_str(), needed);
  return needed;
}

bool poll_event(Event* event, uint32_t) {
  if (scene.quit_told || scene_s() < scene.quit_s) return false;
  scene.quit_told = true;
  event->type = kQuit;
  event->device = 0xFFFFFFFF;
  event->age_s = 0.0f;
  return true;
}

bool get_state(uint32_t index, ControllerState* state, uint32_t size) {
  const Row* row = index < kMostDevices ? row_before(scene.devices[index], scene_s()) : nullptr;
  if (!row || !row->connected || size != sizeof(ControllerState)) return false;
  *state = ControllerState();
  state->pressed = row->buttons;
  return true;
}

void haptic(uint32_t index, uint32_t, unsigned short) { log_line("tick", index); }

void quit_acknowledged() { log_line("acknowledged", scene_s()); }

const char* version() { return "stand-in"; }

void* table[] = {
    nullptr, nullptr, nullptr, nullptr, nullptr, nullptr, nullptr, nullptr, nullptr, nullptr,
    nullptr,
    reinterpret_cast<void*>(get_poses),  // 11 GetDeviceToAbsoluteTrackingPose
    nullptr, nullptr, nullptr, nullptr, nullptr, nullptr,
    reinterpret_cast<void*>(get_role),      // 18 GetControllerRoleForTrackedDeviceIndex
    reinterpret_cast<void*>(get_class),     // 19 GetTrackedDeviceClass
    reinterpret_cast<void*>(is_connected),  // 20 IsTrackedDeviceConnected
    nullptr,
    reinterpret_cast<void*>(get_float),  // 22 GetFloatTrackedDeviceProperty
    nullptr, nullptr, nullptr, nullptr,
    reinterpret_cast<void*>(get_string),  // 27 GetStringTrackedDeviceProperty
    nullptr,
    reinterpret_cast<void*>(poll_event),  // 29 PollNextEvent
    nullptr, nullptr, nullptr, nullptr,
    reinterpret_cast<void*>(get_state),  // 34 GetControllerState
    nullptr,
    reinterpret_cast<void*>(haptic),  // 36 TriggerHapticPulse
    nullptr, nullptr, nullptr, nullptr, nullptr, nullptr, nullptr,
    reinterpret_cast<void*>(quit_acknowledged),  // 44 AcknowledgeQuit_Exiting
    nullptr,
    reinterpret_cast<void*>(version),  // 46 GetRuntimeVersion
};
static_assert(sizeof(table) / sizeof(table[0]) == 47, "the functions of IVRSystem_023");

class Core {  // IVRClientCore_003
 public:
  virtual int Init(int, const char*) {
    read_scene();
    return scene.refuse;
  }
  virtual void Cleanup() {
    if (scene.log) std::fclose(scene.log);
    scene.log = nullptr;
  }
  virtual int IsInterfaceVersionValid(const char* name) {
    return std::strcmp(name, "IVRSystem_023") == 0 ? kNone : kInterfaceNotFound;
  }
  virtual void* GetGenericInterface(const char* name, int* error) {
    const bool known = std::strcmp(name, "FnTable:IVRSystem_023") == 0;
    if (error) *error = known ? kNone : kInterfaceNotFound;
    return known ? table : nullptr;
  }
  virtual bool BIsHmdPresent() { return true; }
  virtual const char* GetEnglishStringForHmdError(int) { return "said by the stand-in"; }
  virtual const char* GetIDForVRInitError(int) { return "VRInitError"; }
};

Core core;

}  // namespace

extern "C" __attribute__((visibility("default"))) void* VRClientCoreFactory(const char* name,
                                                                            int* error) {
  const bool known = std::strcmp(name, "IVRClientCore_003") == 0;
  if (error) *error = known ? kNone : kInterfaceNotFound;
  return known ? &core : nullptr;
}
