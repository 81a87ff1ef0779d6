// The contract of TI's flash library for this chip (Flash2808_API_V302.lib, TI's binary), as far as it is used here.
//
// TI gives the algorithms that erase and program to nobody but this library; hal/f2808/flash.c is its one caller, and
// natively the virtual chip stands in for it (sim_host/chip/flash_library.cpp). Own words, from published headers and
// examples of TI's; only the names and types have to be these.
//
// What the caller owes it
//  * It, and whatever interrupts do meanwhile, runs from RAM without wait states, and nothing touches the flash.
//  * The PLL is locked, SYSCLKOUT at least 10 MHz and constant, Flash_CPUScaleFactor set for it.
//  * The chip is open (CSM), WDOVERRIDE is 1: it stops the watchdog by WDCR.
//  * The supply holds. An erase that is cut off may leave cells in depletion, which disturb their whole sector, and
//    passwords that nobody knows when it was sector A.
// What it owes: the status below; it has verified what it says it has done. A bit that is 0 and should be 1 is
// FLASH_LIBRARY_ZERO_BIT.

#ifndef STILLSPIN_HAL_F2808_FLASH_LIBRARY_H
#define STILLSPIN_HAL_F2808_FLASH_LIBRARY_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define FLASH_LIBRARY_DONE 0u
#define FLASH_LIBRARY_LOCKED 10u      // by the CSM
#define FLASH_LIBRARY_ADDRESS 12u     // not in the flash
#define FLASH_LIBRARY_OTHER_CHIP 13u  // PARTID
#define FLASH_LIBRARY_NO_SECTOR 20u
#define FLASH_LIBRARY_ERASE_FAILED 22u  // 21 to 24: one of the erase's steps
#define FLASH_LIBRARY_PROGRAM_FAILED 30u
#define FLASH_LIBRARY_ZERO_BIT 31u

// Sectors as a mask: bit 0 is A, bit 3 is D.
#define FLASH_LIBRARY_SECTOR(sector) ((uint16_t)(1u << (sector)))
// 2^20 times 200 ns over SYSCLKOUT's period: the library counts its delays by it.
#define FLASH_LIBRARY_SCALE(mhz) ((uint32_t)(1048576uL * (mhz) / 5uL))

// Where it failed.
typedef struct {
  uint32_t first_failed;
  uint16_t expected;
  uint16_t actual;
} flash_library_status_t;

extern uint32_t Flash_CPUScaleFactor;
extern void (*Flash_CallbackPtr)(void);  // called while it waits, from RAM; null for none

uint16_t Flash2808_Erase(uint16_t sectors, flash_library_status_t* status);
uint16_t Flash2808_Program(uint16_t* to, uint16_t* from, uint32_t words, flash_library_status_t* status);

#ifdef __cplusplus
}
#endif

#endif
