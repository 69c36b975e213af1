#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "devices/host/closed_library.h"

namespace passung::dhd {

/// Force Dimension's library 3.x, found and loaded at run time. Lengths in m, angles in rad, forces in N and N·m; -1
/// is failure, 1 (time guard) and 2 (saturated) are notes.
struct DhdLibrary {
    static constexpr const char* kFileVariable = "PASSUNG_DHD_LIBRARY";

    static Result<std::unique_ptr<DhdLibrary>> load(const std::string& file);
    /// What went wrong in the last call, in the vendor's words.
    std::string lastError() const;

    int (*getDeviceCount)() = nullptr;
    int (*openId)(char id) = nullptr;
    int (*close)(char id) = nullptr;
    int (*getSerialNumber)(unsigned short* serial, char id) = nullptr;
    const char* (*getSystemName)(char id) = nullptr;
    void (*getSdkVersion)(int* major, int* minor, int* release, int* revision) = nullptr;
    int (*getStatus)(int* status, char id) = nullptr;
    int (*enableForce)(unsigned char on, char id) = nullptr;
    int (*setWatchdog)(unsigned char milliseconds, char id) = nullptr;
    int (*getPose)(double* px, double* py, double* pz, double matrix[3][3], char id) = nullptr;
    unsigned (*getButtonMask)(char id) = nullptr;
    int (*setWrench)(double fx, double fy, double fz, double tx, double ty, double tz, double grip, char id) = nullptr;
    const char* (*errorGetLastStr)() = nullptr;

    // Null in a library that has them not.
    int (*openSerial)(int serial) = nullptr;
    int (*setBrakes)(int on, char id) = nullptr;
    int (*setMaxForce)(double newtons, char id) = nullptr;
    int (*setMaxTorque)(double newton_metres, char id) = nullptr;
    int (*getVersion)(double* firmware, char id) = nullptr;
    bool (*hasGripper)(char id) = nullptr;
    int (*getGripperAngle)(double* radians, char id) = nullptr;

    int version[4] = {};

private:
    explicit DhdLibrary(std::unique_ptr<host::ClosedLibrary> file) : file_(std::move(file)) {}
    void takeFunctions();

    std::unique_ptr<host::ClosedLibrary> file_;
};

}  // namespace passung::dhd
